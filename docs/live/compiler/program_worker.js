// SPDX-License-Identifier: MIT
// Draws pictures of tests with the reader's program, and says how they differ from the golden ones.
// What it is loaded behind: lesson.js.

import { unpacked } from "./unpacked.js";
import { ConsoleStdout, File, OpenFile, WASI } from "./wasi/index.js";

let judge;  // the instance of judge.wasm

async function pixelsOf(blob) {
  const bitmap = await createImageBitmap(blob, { colorSpaceConversion: "none", premultiplyAlpha: "none" });
  const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
  context.drawImage(bitmap, 0, 0);
  return context.getImageData(0, 0, bitmap.width, bitmap.height);
}

/** Hands two pictures over to judge.cpp; a text comes back. */
async function judged(blob, own, expected, width, height, mayJump) {
  if (!judge) {
    const bytes = await (await unpacked(blob)).arrayBuffer();
    const nothing = new Proxy({}, { get: () => () => 52 });
    judge = (await WebAssembly.instantiate(bytes, { wasi_snapshot_preview1: nothing, page: nothing, env: nothing })).instance.exports;
    judge._initialize();
  }
  const at = judge.room(width, height) >>> 0;
  const memory = new Uint8Array(judge.memory.buffer);
  memory.set(own, at);
  memory.set(expected, at + 4 * width * height);
  const text = judge.judge(mayJump) >>> 0;
  const bytes = new Uint8Array(judge.memory.buffer, text);
  return new TextDecoder().decode(bytes.subarray(0, bytes.indexOf(0)));
}

/** Words of a command line, as settings of a lesson. */
function settingsOf(lesson, words) {
  const settings = {};
  for (let i = 0; i < words.length; ++i) {
    const control = lesson.controls.find(({ name }) => name === words[i]);
    if (!control) throw new LessonError(`the program has no ${words[i]}`);
    settings[words[i]] = control.kind === "flag" ? "true" : words[++i];
  }
  return settings;
}

const tasks = {
  draw: async ({ program, picture, scene, golden, judgeBlob }) => {
    const module = await WebAssembly.compile(program);
    const lesson = new Lesson(module);
    const words = [...picture.options];
    const model = words.indexOf("--model");
    if (model >= 0) words.splice(model, 2);
    lesson.set(settingsOf(lesson, words));
    const { width, height, data } = await pixelsOf(golden);
    lesson.take(await scene);
    const own = lesson.draw(width, height);
    return { text: await judged(judgeBlob, own, data, width, height, picture.mayJump) };
  },

  model: async ({ program }) => ({ model: new Lesson(await WebAssembly.compile(program)).model }),

  /** Runs the tests of formulas; also what they have printed before they ended by a trap comes back. */
  run: async ({ program, lesson }) => {
    let text = "", said = "";
    const files = [
      new OpenFile(new File([])),
      new ConsoleStdout((bytes) => (text += new TextDecoder().decode(bytes))),
      new ConsoleStdout((bytes) => (said += new TextDecoder().decode(bytes))),
    ];
    const wasi = new WASI(["tests", lesson], [], files, { debug: false });
    const nothing = new Proxy({}, { get: () => () => 0 });
    try {
      wasi.start(new WebAssembly.Instance(await WebAssembly.compile(program), { wasi_snapshot_preview1: wasi.wasiImport, page: nothing }));
      return { text, ended: "" };
    } catch (error) {
      error.said = said;
      return { text, ended: inWords(error).replace("the program ended", "ended") };
    }
  },

  judge: async ({ judgeBlob, own, expected, width, height }) => ({ text: await judged(judgeBlob, own, expected, width, height, 0) }),
};

function inWords(error) {
  if (error instanceof LessonError) return `${error.message}`;
  const [, name] = String(error.stack).match(/^ *at (.+) \(wasm:|^(?=.*wasm-function)([^@]+)@/m) ?? [];
  const where = name ? ` in ${name.replace(/^\S+\.wasm\./, "")}` : "";
  return `the program ended${where}: ${error.said?.trim() || error.message}`;
}

onmessage = async ({ data }) => {
  try {
    postMessage({ id: data.id, ...(await tasks[data.task](data)) });
  } catch (error) {
    postMessage({ id: data.id, error: inWords(error) });
  }
};
