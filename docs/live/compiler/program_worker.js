// SPDX-License-Identifier: MIT
// Draws pictures of tests with the reader's program, and says how they differ from the golden ones.
// pack.py puts lesson.js behind it.

import { readPicture } from "./read_picture.js";
import { unpacked } from "./unpacked.js";
import { ConsoleStdout, File, OpenFile, WASI } from "./wasi/index.js";

let judge;  // the instance of judge.wasm
const scenes = {};

/** A packed scene, from the script that pages load it with. */
async function sceneOf(model) {
  if (!scenes[model]) {
    const answer = await fetch(new URL(`../${model.split("/").at(-1)}.js`, import.meta.url));
    if (!answer.ok) throw new LessonError(`the scene ${model} cannot be fetched`);
    const [, text] = (await answer.text()).match(/= "(.*)";/);
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    scenes[model] = new Uint8Array(await (await unpacked(new Blob([bytes]))).arrayBuffer());
  }
  return scenes[model];
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
  /** Says how a picture differs from the golden one; nothing where it does not. */
  draw: async ({ program, picture, judgeBlob }) => {
    const lesson = new Lesson(await WebAssembly.compile(program));
    const words = [...picture.options];
    const at = words.indexOf("--model");
    const model = at >= 0 ? words.splice(at, 2)[1] : lesson.model;
    lesson.set(settingsOf(lesson, words));
    lesson.take(await sceneOf(model));
    const { width, height, data } = await readPicture(new URL(`golden/${picture.golden}`, import.meta.url));
    return { text: await judged(judgeBlob, lesson.draw(width, height), data, width, height, picture.mayJump) };
  },

  /** Runs the tests of formulas; what they print is told at once, as they may never end, and comes back also when they end by a trap. */
  run: async ({ id, program, lesson }) => {
    let text = "", said = "";
    const files = [
      new OpenFile(new File([])),
      new ConsoleStdout((bytes) => {
        const more = new TextDecoder().decode(bytes);
        text += more;
        postMessage({ id, more });
      }),
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
  if (error instanceof LessonError) return error.message;
  const name = functionOf(error);
  const where = name ? ` in ${name}` : "";
  return `the program ended${where}: ${error.said?.trim() || error.message}`;
}

onmessage = async ({ data }) => {
  try {
    postMessage({ id: data.id, ...(await tasks[data.task](data)) });
  } catch (error) {
    postMessage({ id: data.id, error: inWords(error) });
  }
};
