// SPDX-License-Identifier: MIT
// A C++ compiler in the page, for the editor: fetched when it is first asked for, run in workers.
//
//   const toolchain = new Toolchain();
//   await toolchain.load(({ bytes, of, what }) => ...);
//   const { messages, log, program } = await toolchain.compile("05_textures", { "main.cpp": text, ... });
//   const { messages, log, tiers, first } = await toolchain.test("05_textures", files, step);
//
// What goes wrong in the page rejects with an Error whose message is a sentence; what stop() ends,
// with one named "AbortError".

const at = (path) => new URL(path, import.meta.url);
const mostSeconds = { draw: 60, test: 30 };  // for a picture of a test, or a test of a formula
const mostCompileSeconds = 300;

const objectOf = (source) => `${source.replaceAll("/", "_")}.o`;
const shared = ["docs/live/live_app.cpp", "common/app/empty_picture.cpp", "common/app/option_parser.cpp", "common/probe/pixel_trace.cpp"].map(objectOf);

/** Where one compiles, links, draws or runs what the reader wrote; it can be ended at any time. */
class Helper {
  constructor(script, begin) {
    this.script = script;
    this.begin = begin;  // what a new worker is told first
    this.asked = new Map();
    this.count = 0;
  }

  start() {
    this.worker = new Worker(at(this.script), { type: "module" });
    this.worker.onmessage = ({ data: { id, error, more, ...answer } }) => {
      const asked = this.asked.get(id);
      if (more !== undefined) return asked.goOn(more);
      const { resolve, reject, timer } = asked;
      this.asked.delete(id);
      clearTimeout(timer);
      if (error === undefined) resolve(answer);
      else reject(new Error(error));
    };
    this.worker.onerror = () => this.end(new Error("The compiler's worker ended: there may not be enough memory."));
    this.ready = this.begin ? this.send(this.begin) : Promise.resolve();
  }

  /** Whatever it says before its answer gives it `seconds` more; if it ends without one, the error has all that as `said`. */
  send(message, seconds = null) {
    return new Promise((resolve, reject) => {
      const id = ++this.count;
      const asked = { resolve, reject, said: "" };
      asked.goOn = (more) => {
        asked.said += more;
        clearTimeout(asked.timer);
        asked.timer = seconds && setTimeout(() => this.end(new Error(`did not end within ${seconds} seconds`)), 1000 * seconds);
      };
      asked.goOn("");
      this.asked.set(id, asked);
      this.worker.postMessage({ id, ...message });
    });
  }

  async ask(message, seconds) {
    if (!this.worker) this.start();
    await this.ready;
    return this.send(message, seconds);
  }

  /** The next question starts it anew. */
  end(error) {
    this.worker?.terminate();
    this.worker = null;
    for (const { reject, timer, said } of this.asked.values()) {
      clearTimeout(timer);
      reject(Object.assign(error, { said }));
    }
    this.asked.clear();
  }

  stop() {
    if (this.asked.size > 0) this.end(Object.assign(new Error("Stopped."), { name: "AbortError" }));
  }
}

/** Keeps the answer to what was asked last; where there was none, it is asked again. */
class Latest {
  answer(question, find) {
    if (this.question !== question) {
      this.question = question;
      this.found = find();
      this.found.catch(() => {
        if (this.question === question) this.question = null;
      });
    }
    return this.found;
  }
}

/** Fetches a file, or takes it from what the browser has kept of this version. */
async function fetched(name, version, progress) {
  const cache = await globalThis.caches?.open("rasterbook compiler").catch(() => null);
  const url = at(`${name}?${version}`).href;
  const kept = await cache?.match(url);
  if (kept) {
    const blob = await kept.blob();
    progress(blob.size);
    return blob;
  }
  const answer = await fetch(url).catch(() => null);
  if (!answer?.ok) throw new Error("The compiler cannot be fetched.");
  const parts = [];
  let bytes = 0;
  const reader = answer.body.getReader();
  for (let part; !(part = await reader.read()).done;) {
    parts.push(part.value);
    progress((bytes += part.value.length));
  }
  const blob = new Blob(parts);
  await cache?.put(url, new Response(blob)).catch(() => {});  // a full disk is no reason to stop
  return blob;
}

/** What is kept of older versions takes room. */
async function forgetOthers(version) {
  const cache = await globalThis.caches?.open("rasterbook compiler").catch(() => null);
  for (const request of (await cache?.keys()) ?? [])
    if (!request.url.endsWith(`?${version}`)) await cache.delete(request);
}

export class Toolchain {
  compiled = new Latest();
  objects = [new Latest(), new Latest()];  // of main.cpp, and of what is compiled beside it
  tests = new Latest();

  async load(progress) {
    this.loading ??= this.fetchAll(progress).catch((error) => {
      this.loading = null;
      throw error;
    });
    await this.loading;
  }

  async fetchAll(progress) {
    const json = async (name, how) => {
      const answer = await fetch(at(name), how).catch(() => null);
      if (!answer?.ok) throw new Error("The compiler cannot be fetched.");
      return answer.json();
    };
    const { version, searchPath, sizes } = await json("manifest.json", { cache: "no-cache" });
    this.lessons = await json("lessons.json");
    const all = Object.values(sizes).reduce((sum, size) => sum + size, 0);
    const got = {};
    const blobs = {};
    for (const name of Object.keys(sizes))
      blobs[name] = await fetched(name, version, (bytes) => {
        got[name] = bytes;
        progress({ bytes: Object.values(got).reduce((sum, size) => sum + size, 0), of: all, what: "the compiler" });
      });
    await forgetOthers(version);
    this.judgeBlob = blobs["judge.wasm.gz"];
    const begin = { task: "load", blobs, version, searchPath };
    this.compilers = [new Helper("compiler_worker.js", begin), new Helper("compiler_worker.js", begin)];
    this.drawing = new Helper("program_worker.js");
    this.testing = new Helper("program_worker.js");
    for (const helper of this.compilers) helper.start();
  }

  compile(lesson, files) {
    return this.compiled.answer(JSON.stringify([lesson, files]), () => this.compileAnew(lesson, files));
  }

  /** @returns  Among others `program`, null where it does not compile. */
  async compileAnew(lesson, files) {
    const isLesson = lesson in this.lessons;
    const main = isLesson ? `lessons/${lesson}/main.cpp` : `lessons/sandbox/main.cpp`;
    const { apart = this.apartOf(lesson) } = this.lessons[lesson] ?? {};
    const own = { lesson, files, like: this.likeThoseOf(lesson) };
    // What is precompiled takes longest when it is first asked for: one does it for both, the other takes it from the browser.
    this.precompiled = this.compilers[0].ask({ task: "precompile", ...own, main, apart }, mostCompileSeconds);
    const { uses } = await this.precompiled;
    const compile = (compiler, sources, level) =>
      this.compilers[compiler].ask({ task: "compile", ...own, sources, level }, mostCompileSeconds);
    let free = 0;  // the first compiler, and what comes next takes the other
    /** Not anew where all that the sources include is as before. */
    const object = (kept, sources, level) => {
      const used = [...new Set(sources.flatMap((source) => uses[source]))].map((name) => [name, files[name]]);
      return kept.answer(JSON.stringify([lesson, sources, level, used]), () => compile(free++, sources, level));
    };
    const changed = apart.filter((source) => uses[source]?.length > 0);  // the others are not needed, or compiled already
    // From lesson 06 on there is much to draw: what draws is optimised, apart from the rest.
    const draws = (source) => (source === main ? isLesson && lesson >= "06" : /(shadows|casters)\.cpp$/.test(source));
    const unlikeMain = changed.filter((source) => draws(source) !== draws(main));
    const beside = unlikeMain.length > 0 ? unlikeMain : changed;  // on the other core
    const parts = [[...changed.filter((source) => !beside.includes(source)), main], beside]
      .filter((sources) => sources.length > 0)
      .map((sources, i) => object(this.objects[i], sources, draws(sources[0]) ? "-O1" : "-O0"));
    const all = Promise.all(parts);
    all.catch(() => {});  // nobody waits for it where main.cpp does not compile
    const { messages, log: said, object: compiledMain } = await parts[0];
    if (!compiledMain) return { messages, log: said, program: null };
    const compiled = await all;
    const wrong = compiled.find((part) => !part.object);
    if (wrong) return { messages: wrong.messages, log: wrong.log, program: null };
    const { program, log } = await this.compilers[0].ask({
      task: "link", compiled: compiled.map((part) => part.object),
      names: [...shared, ...this.apartOf(lesson).filter((source) => !changed.includes(source)).map(objectOf)],
      start: ["/objects/crt1-reactor.o", "--entry", "_initialize"],
    }, mostCompileSeconds);
    return { messages: program ? messages : linkMessages(log), log, program };
  }

  /** Files that include what is worth to be precompiled: the lesson's, and its tests. */
  likeThoseOf(lesson) {
    if (!(lesson in this.lessons)) return ["lessons/05_textures/main.cpp", ...this.apartOf(lesson)];
    const { before, apart, tests } = this.lessons[lesson];
    const mains = [lesson, ...(before ? [before] : [])].map((name) => `lessons/${name}/main.cpp`);
    return [...mains, ...apart, "docs/live/compiler/formula_tests.hpp", ...tests];
  }

  /** A program is linked with the sources beside main.cpp of its lesson and, as it begins with the main.cpp of the one before, of that one. */
  apartOf(lesson) {
    if (!(lesson in this.lessons)) return Object.values(this.lessons).flatMap(({ apart }) => apart);
    const { before, apart } = this.lessons[lesson];
    return [...new Set([...apart, ...(before ? this.apartOf(before) : [])])];
  }

  /**
   * Asked together with compile(), it uses the other core.
   *
   * @param {Promise} drawn  Pictures of tests wait for it, but not for long: the reader's own comes first.
   */
  async test(lesson, files, step, drawn = null) {
    const compiled = this.compile(lesson, files);
    const { steps } = this.lessons[lesson];
    const done = step ? steps.slice(0, step) : steps;
    const isAll = !step || step === steps.length;
    const equations = isAll ? "*" : done.flatMap(({ equations }) => equations).join(" ");
    const known = this.lessons[lesson].pictures;
    const names = step ? done.at(-1).pictures.filter((name) => name in known) : Object.keys(known);
    const [formulas, pictures] = await Promise.all([this.formulas(lesson, files, equations, compiled), this.pictures(lesson, names, compiled, drawn)]);
    if (formulas.messages) return { messages: formulas.messages, log: formulas.log, tiers: [], first: null };
    const tiers = [{ name: "formulas", passed: formulas.passed, total: formulas.total }];
    if (names.length > 0) tiers.push({ name: "pictures", passed: pictures.passed, total: names.length });
    return { messages: [], log: "", tiers: tiers.filter(({ total }) => total > 0), first: formulas.first ?? pictures.first };
  }

  async formulas(lesson, files, equations, compiled) {
    if (equations === "" || this.lessons[lesson].tests.length === 0) return { passed: 0, total: 0, first: null };
    const { "main.cpp": _, ...headers } = files;  // the tests do not include it
    const tests = await this.tests.answer(JSON.stringify([lesson, headers, equations]), () => this.compileTests(lesson, headers, equations));
    if (!tests.program) return tests;
    if (!(await compiled).program) return { passed: 0, total: 0, first: null };
    let text, ended = "";
    try {
      ({ text, ended } = await this.testing.ask({ task: "run", program: tests.program, lesson }, mostSeconds.test));
    } catch (error) {
      if (error.name === "AbortError") throw error;
      ended = error.message;
      text = error.said ?? "";
    }
    return outcome(text, ended);
  }

  async compileTests(lesson, files, equations) {
    const sources = this.lessons[lesson].tests;
    const own = { lesson, files, like: this.likeThoseOf(lesson), sources, level: "-O0" };  // they take longer to be compiled than to run
    await this.precompiled;  // and the lesson's sources come first, for the picture
    const { object, messages, log } = await this.compilers[1].ask({
      task: "compile", ...own, extra: [`-DASKED_EQUATIONS="${equations}"`, "-include", "/docs/live/compiler/formula_tests.hpp"],
    }, mostCompileSeconds);
    if (!object) return { messages: messages.length > 0 ? messages : [errorOf(log)], log };
    const apart = this.apartOf(lesson).map(objectOf);
    const names = ["docs_live_compiler_formula_tests.cpp.o", "gtest-all.o", "tests_support_visibility.cpp.o", ...shared, ...apart];
    const linked = await this.compilers[1].ask(
      { task: "link", compiled: [object], names, start: ["/objects/crt1-command.o"] }, mostCompileSeconds);
    return linked.program ? linked : { messages: linkMessages(linked.log), log: linked.log };
  }

  async pictures(lesson, names, compiled, drawn) {
    let passed = 0, first = null;
    const { program } = await compiled;
    if (!program) return { passed, first };
    await Promise.race([drawn, new Promise((resolve) => setTimeout(resolve, 5000))]);
    for (const name of names) {
      const picture = this.lessons[lesson].pictures[name];
      let text;
      try {
        ({ text } = await this.drawing.ask({ task: "draw", program, picture, judgeBlob: this.judgeBlob }, mostSeconds.draw));
      } catch (error) {
        if (error.name === "AbortError") throw error;
        text = error.message;
      }
      if (text === "") ++passed;
      else {
        const { suite, place, options, golden } = picture;
        const drawn = options.length > 0 ? `with ${options.join(" ")}, ` : "";
        first ??= { text: `FAILED ${suite}.${name}\n${place}: ${drawn}${text}`, picture: { name, options, golden } };
      }
    }
    return { passed, first };
  }

  async diagnose(lesson, own, expected, width, height) {
    const { text } = await this.drawing.ask({ task: "judge", judgeBlob: this.judgeBlob, own, expected, width, height }, mostSeconds.draw);
    return text.replace(/^[^]*?\nThe picture: /, "");
  }

  stop() {
    for (const helper of [...(this.compilers ?? []), this.drawing, this.testing]) helper?.stop();
  }
}

/** An error of no place. */
const errorOf = (text) => ({ file: "", line: 0, column: 0, severity: "error", text });

/** What the linker misses, without what it is missed by. */
function linkMessages(log) {
  const names = new Set([...log.matchAll(/undefined symbol: (.*)/g)].map(([, name]) => name));
  const missing = (name) => (/^(__main_argc_argv|main)$/.test(name) ? "there is no main()" : `${name} is declared, but defined nowhere`);
  const texts = names.size > 0 ? [...names].map(missing) : [log || "The program cannot be linked."];
  return texts.map(errorOf);
}

/** What the tests of formulas have printed, in the equations' order. */
function outcome(text, ended) {
  const said = text.split("\x01").slice(1).map((part) => part.match(/^(\w+) (\S+)\n([^]*)$/)).filter(Boolean);
  const of = (kind) => said.filter(([, is]) => is === kind);
  const place = ([, , name, text]) => `${text.match(/^To read: .*?\.md, (.*)$/m)?.[1] ?? ""}~${name}`;  // as ./tests/run sorts them
  const inOrder = of("failed").sort((a, b) => place(a).localeCompare(place(b), "en", { numeric: true }));
  const running = of("running").at(-1)?.[2];
  const finished = new Set([...of("passed"), ...of("failed")].map(([, , name]) => name));
  let first = inOrder.length > 0 ? { text: inOrder[0][3].trimEnd() } : null;
  if (ended && !(running && finished.has(running)))
    first ??= { text: `FAILED ${running ?? ""}\n${running ?? "The tests of formulas"} ${ended}` };
  const total = Math.max(of("running").length, 1);
  return { passed: of("passed").length, total: ended ? Math.max(total, finished.size + 1) : total, first };
}
