// SPDX-License-Identifier: MIT
// A lesson's program, compiled to WebAssembly, with a scene: what live_app.cpp exports, as methods.

/** What a lesson says is wrong; else it ends by a trap. */
class LessonError extends Error {}

class Lesson {
  /** @param {WebAssembly.Module} module  Of a lesson, not of a scene. */
  constructor(module) {
    this.printed = "";
    this.said = "";
    const left = {};
    const write = (file, vectors, count, written) => {
      const memory = this.view();
      let bytes = 0;
      for (let i = 0; i < count; ++i) {
        const at = memory.getUint32(vectors + 8 * i, true);
        const size = memory.getUint32(vectors + 8 * i + 4, true);
        const text = new TextDecoder().decode(new Uint8Array(this.exports.memory.buffer, at, size));
        if (file === 1) this.printed += text;
        else this.said += text;
        bytes += size;
      }
      memory.setUint32(written, bytes, true);
      return 0;
    };
    const isOutput = (file) => file === 1 || file === 2;
    const badFile = 8, unsupported = 52;
    const system = {
      environ_sizes_get: (count, size) => {
        this.view().setUint32(count, 0, true);
        this.view().setUint32(size, 0, true);
        return 0;
      },
      environ_get: () => 0,
      clock_time_get: (clock, precision, time) => {
        this.view().setBigUint64(time, BigInt(Math.round(performance.now() * 1e6)), true);
        return 0;
      },
      fd_write: (file, ...rest) => (isOutput(file) ? write(file, ...rest) : badFile),
      proc_exit: (status) => {
        throw new LessonError(`the program ended with the exit status ${status}`);
      },
    };
    const page = {
      leave: () => {
        throw left;
      },
      fail: (text) => {
        throw new LessonError(this.text(text));
      },
    };
    // Of files there are none: whatever else the C library asks for is not there.
    const others = (known) =>
      new Proxy(known, { get: (target, name) => target[name] ?? (() => (name.startsWith("fd_") ? badFile : unsupported)) });
    this.exports = new WebAssembly.Instance(module, { wasi_snapshot_preview1: others(system), page }).exports;
    this.exports._initialize();
    try {
      this.exports.start();
    } catch (error) {
      if (error !== left) throw error;
    }
    const described = JSON.parse(this.text(this.exports.controls()));
    Object.assign(this, described);  // model, hasProbe, methods, controls
  }

  /** An error of the program takes along what the C++ library has said last. */
  call(name, ...values) {
    try {
      return this.exports[name](...values);
    } catch (error) {
      error.said = this.said;
      throw error;
    }
  }

  view() {
    return new DataView(this.exports.memory.buffer);
  }

  /** @param {number} at  Of a text that ends with a zero. */
  text(at) {
    const bytes = new Uint8Array(this.exports.memory.buffer, at);
    return new TextDecoder().decode(bytes.subarray(0, bytes.indexOf(0)));
  }

  handOver(bytes) {
    const at = this.call("room", bytes.length) >>> 0;
    new Uint8Array(this.exports.memory.buffer).set(bytes, at);
  }

  /** Sets what is named; the later of two controls counts more, as on the command line. */
  set(settings) {
    const names = this.controls.map((control) => control.name);
    for (const name of Object.keys(settings))
      if (!names.includes(name)) throw new LessonError(`this lesson has no ${name}`);
    this.controls.forEach((control, i) => {
      if (!(control.name in settings)) return;
      const value = settings[control.name];
      this.handOver(new TextEncoder().encode(value));
      if (!this.exports.set(i)) throw new LessonError(`${control.name}: '${value}' is not ${valuesOf(control)}`);
    });
  }

  /** @param {Uint8Array} scene  As pack_scene writes it. */
  take(scene) {
    this.handOver(scene);
    this.call("take_scene");
    this.call("prepare");
  }

  /** @return {Uint8ClampedArray}  Four bytes a pixel. */
  draw(width, height) {
    this.printed = "";
    const at = this.call("draw", width, height) >>> 0;
    return new Uint8ClampedArray(this.exports.memory.buffer.slice(at, at + 4 * width * height));
  }

  /** Why a pixel of the picture drawn last has its colour. */
  probe(x, y) {
    return this.text(this.call("probe", x, y));
  }
}

/** The function of a program that ended by a trap, without its module's name; undefined where none is known. */
function functionOf(error) {
  const [, inChromium, inFirefox] = String(error.stack).match(/^ *at (.+) \(wasm:|^(?=.*wasm-function)([^@]+)@/m) ?? [];
  return (inChromium ?? inFirefox)?.replace(/^\S+\.wasm\./, "");
}

/** What a control takes, in words. */
function valuesOf(control) {
  if (control.kind === "flag") return "true or false";
  if (control.kind === "choice") return `one of ${control.words.join(", ")}`;
  return `a ${control.isWhole ? "whole " : ""}number from ${control.least} to ${control.most}`;
}
