// SPDX-License-Identifier: MIT
// Compiles and links in a worker: clang and lld, themselves WebAssembly, on files in memory.
// Each message is answered by one with the same id.

import { unpacked } from "./unpacked.js";
import { ConsoleStdout, Directory, File, OpenFile, PreopenDirectory, WASI } from "./wasi/index.js";

const options = ["--target=wasm32-wasi", "-std=c++20", "-ffp-contract=off", "-fno-math-errno", "-fignore-exceptions", "-Wall", "-Wextra",
  "-Wno-psabi", "-Wno-unused-parameter", "-Wno-missing-field-initializers", "-fno-color-diagnostics",
  "-fdiscard-value-names", "-fno-verify-intermediate-code",  // as where clang is not built with assertions
  "-D_LIBCPP_HAS_NO_EXCEPTIONS",  // its vectors then need not know how to undo what is half done
  "-DRASTERBOOK_IN_A_PAGE", "-DRASTERBOOK_PROBE", "-DGTEST_HAS_EXCEPTIONS=0", "-DGTEST_HAS_PTHREAD=0", "-DGTEST_HAS_STREAM_REDIRECTION=0",
  '-DRASTERBOOK_ASSETS=""', '-DRASTERBOOK_LESSONS=""', '-DRASTERBOOK_GOLDEN=""', '-DRASTERBOOK_TEST_DATA=""',
  "-nostdinc", "-nostdinc++", "-I/docs/live/without_threads", "-I/mine", "-I/", "-I/lessons", "-I/tests"];

let compiler;  // WebAssembly.Module
const root = new Map();  // the files, as folders in folders
const texts = new Map();  // the course's files: text by path
let version, searchPath;
let precompiled;  // what is precompiled for a lesson

const encoder = new TextEncoder();
const bytesOf = async (blob) => new Uint8Array(await (await unpacked(blob)).arrayBuffer());

/** @param {Uint8Array | string} data */
function put(path, data) {
  const parts = path.split("/");
  let folder = root;
  for (const part of parts.slice(0, -1)) {
    if (!folder.has(part)) folder.set(part, new Directory(new Map()));
    folder = folder.get(part).contents;
  }
  const file = new File(new ArrayBuffer(0));
  file.data = typeof data === "string" ? encoder.encode(data) : data;
  folder.set(parts.at(-1), file);
}

function get(path) {
  let entry = { contents: root };
  for (const part of path.split("/")) entry = entry?.contents?.get(part);
  return entry?.data;
}

/** Runs a tool of LLVM; what it prints comes back. */
function run(args, input = "") {
  const printed = [], said = [];
  const files = [
    new OpenFile(new File(encoder.encode(input))),
    new ConsoleStdout((bytes) => printed.push(bytes.slice())),
    new ConsoleStdout((bytes) => said.push(bytes.slice())),
    new PreopenDirectory("/", root),
  ];
  const wasi = new WASI(args, [], files, { debug: false });
  const instance = new WebAssembly.Instance(compiler, { wasi_snapshot_preview1: wasi.wasiImport });
  const status = wasi.start(instance);
  return { status, bytes: joined(printed), text: new TextDecoder().decode(joined(said)) };
}

function joined(parts) {
  const all = new Uint8Array(parts.reduce((sum, part) => sum + part.length, 0));
  let at = 0;
  for (const part of parts) {
    all.set(part, at);
    at += part.length;
  }
  return all;
}

const commands = new Map();  // what the driver makes of its words

/** Runs clang as its driver would run it, but in the same program. */
function clang(args, input) {
  const key = args.join("\n");
  if (!commands.has(key)) {
    const driver = run(["clang++", ...options, ...searchPath, ...args, "-###"]);
    const line = driver.text.split("\n").find((line) => line.startsWith(' "'));
    if (driver.status !== 0 || !line) return driver;
    const words = [...line.matchAll(/"((?:[^"\\]|\\.)*)"/g)].map(([, word]) => word.replace(/\\(.)/g, "$1"));
    commands.set(key, words[0] === "" ? words.slice(1) : words);
  }
  return run(commands.get(key), input);
}

// --- What includes what

const folders = ["docs/live/without_threads/", "", "lessons/", "tests/"];  // in which the course's headers are looked for
const found = (name) => folders.map((folder) => folder + name).find((path) => texts.has(path));
const includesOf = (text) =>
  [...text.matchAll(/^[ \t]*#[ \t]*include[ \t]*([<"])([^>"]+)[>"]/gm)].map(([, quote, name]) => ({ isOwn: quote === '"', name }));

/** The headers that some files include, themselves or by others; those that depend on one of `own` are left out. */
function headersOf(files, own) {
  const known = new Map();
  const depends = (path) => {
    if (known.has(path)) return known.get(path);
    known.set(path, false);
    const is = own.has(path) || includesOf(texts.get(path)).some(({ isOwn, name }) => isOwn && found(name) && depends(found(name)));
    known.set(path, is);
    return is;
  };
  const headers = new Set(), seen = new Set();
  const visit = (path) => {
    if (seen.has(path)) return;
    seen.add(path);
    for (const { isOwn, name } of includesOf(texts.get(path))) {
      const header = isOwn && found(name);
      if (!isOwn) headers.add(name);
      else if (header) {
        if (!depends(header)) headers.add(name);
        visit(header);
      }
    }
  };
  files.filter((file) => texts.has(file)).forEach(visit);
  return [...headers];
}

/** Where a file of the reader's stands below mine/. */
const pathOf = (name, lesson) => (name.includes("/") ? name : `${lesson}/${name}`);

/** What a source is or includes, itself or by others: `files`, by their paths, and the names of those that are the reader's. */
function includedBy(source, lesson, files) {
  const names = new Map(Object.keys(files).map((name) => [`lessons/${pathOf(name, lesson)}`, name]));
  const own = new Set(), seen = new Set();
  const visit = (path) => {
    if (seen.has(path)) return;
    seen.add(path);
    const name = names.get(path);
    if (name !== undefined) own.add(name);
    for (const { name: included } of includesOf(files[name] ?? texts.get(path) ?? "")) {
      const besides = path.replace(/[^/]*$/, "");
      const header = [besides, ...folders].map((folder) => folder + included).find((file) => names.has(file) || texts.has(file));
      if (header) visit(header);
    }
  };
  visit(source);
  return { files: seen, own };
}

/** Which of the sources a program is made of, and which of the reader's files each of them includes: a source belongs to the header of its name. */
function usedBy(main, apart, lesson, files) {
  const uses = {};
  const headerOf = (source) => source.replace(/\.cpp$/, ".hpp");
  const visit = (source) => {
    const { files: included, own } = includedBy(source, lesson, files);
    uses[source] = [...own];
    for (const other of apart)
      if (!(other in uses) && (included.has(headerOf(other)) || !texts.has(headerOf(other)))) visit(other);
  };
  visit(main);
  return uses;
}

/** The reader's files in place of the course's. */
function putOwn(lesson, files) {
  root.delete("mine");
  const own = new Set();
  for (const [name, text] of Object.entries(files)) {
    const path = pathOf(name, lesson);
    put(`mine/${path}`, text);
    own.add(`lessons/${path}`).add(path);
  }
  return own;
}

const textOf = (headers) => headers.map((name) => `#include <${name}>\n`).join("");

/**
 * Text that includes headers, as a file for -include-pch.
 *
 * @param {string[]} before  Options that include what is precompiled already.
 */
function pchOf(text, before = []) {
  const { status, bytes, text: said } = clang(
    ["-x", "c++-header", ...before, "-Xclang", "-fpch-instantiate-templates", "-c", "-", "-o", "-"], text);
  if (status !== 0) throw new Error(`The course's headers do not compile: ${said.slice(0, 500)}`);
  return bytes;
}

const including = (pch) => ["-include-pch", pch, "-Xclang", "-fno-validate-pch"];

/** Precompiles what does not change while the reader writes, or takes what the browser has kept of it. */
async function precompile(headers) {
  const text = textOf(headers);
  if (precompiled === text) return;
  const file = "precompiled.pch";
  const cache = await globalThis.caches?.open("rasterbook compiler").catch(() => null);
  const hash = cache && new Uint8Array(await crypto.subtle.digest("SHA-256", encoder.encode([...options, text].join("\n"))));
  const url = cache && `${self.origin}/precompiled/${[...hash].map((byte) => byte.toString(16)).join("")}?${version}`;
  const kept = await cache?.match(url);
  if (kept) put(file, await bytesOf(await kept.blob()));
  else {
    const bytes = pchOf(text, including("/shared.pch"));
    put(file, bytes);
    // The other worker takes it from there. Packed it is half of up to 16 MB; a full disk is no reason to stop.
    await cache?.put(url, new Response(new Blob([bytes]).stream().pipeThrough(new CompressionStream("gzip")))).catch(() => {});
  }
  precompiled = text;
}

/** What clang says, for each place; paths as the reader knows them. An error in the course's code is put where the reader's leads to it. */
function messagesOf(text, lesson) {
  const mine = (path) => path.replace(/^\/?mine\//, "").replace(`${lesson}/`, "").replace(/^\//, "");
  const messages = [...text.matchAll(/^(.+?):(\d+):(\d+): (?:fatal )?(error|warning|note): (.*)$/gm)].map(([, file, line, column, severity, words]) => (
    { place: { file: mine(file), line: +line, column: +column }, isOwn: /^\/?mine\//.test(file), severity, text: words }));
  let first;  // the error or warning that notes belong to
  for (const message of messages) {
    if (message.severity !== "note") first = message;
    else if (first && message.isOwn && !first.isOwn) {
      [first.place, message.place] = [message.place, first.place];
      first.isOwn = true;
      message.text = `This ${first.severity} is here.`;
    }
  }
  return messages.map(({ place, severity, text }) => ({ ...place, severity, text }));
}

const mostLog = 6000;
function shortened(log) {
  if (log.length <= mostLog) return log;
  const first = log.search(/: (?:fatal )?error: /);
  const second = log.slice(first + 1).search(/^.*: (?:fatal )?error: /m);
  return `${log.slice(0, Math.min(second > 0 ? first + 1 + second : mostLog, mostLog))}...\n`;
}

const tasks = {
  load: async ({ blobs, version: of, searchPath: path }) => {
    version = of;
    searchPath = path.flatMap((folder) => ["-isystem", folder]);
    const wasm = (await unpacked(blobs["llvm.wasm.gz"])).body;
    compiler = await WebAssembly.compileStreaming(new Response(wasm, { headers: { "Content-Type": "application/wasm" } }));
    for (const [path, text] of Object.entries(await (await unpacked(blobs["texts.json.gz"])).json())) {
      put(path, text);
      texts.set(path, text);
    }
    const packed = await bytesOf(blobs["objects.gz"]);
    const length = new DataView(packed.buffer).getUint32(0, true);
    let at = 4 + length;
    for (const [name, size] of Object.entries(JSON.parse(new TextDecoder().decode(packed.subarray(4, at))))) {
      put(`objects/${name}`, packed.subarray(at, at + size));
      at += size;
    }
    const shared = blobs["shared.pch.gz"];  // not there yet while it is made
    if (shared) put("shared.pch", await bytesOf(shared));
    return {};
  },

  /** Precompiles all that some files include and that depends on no lesson. */
  precompileShared: ({ files }) => {
    const ofLessons = new Set([...texts.keys()].filter((path) => path.startsWith("lessons/")));
    return { bytes: pchOf(textOf(headersOf(files, ofLessons))) };
  },

  /** Precompiles what some files include; says which of the reader's files each source of the program `uses`. */
  precompile: async ({ lesson, files, like, main, apart }) => {
    await precompile(headersOf(like, putOwn(lesson, files)));
    return { uses: usedBy(main, apart, lesson, files) };
  },

  /**
   * Compiles sources as one, after precompile().
   *
   * @param {string} level    Of optimisation: "-O0" or "-O1". What is precompiled serves both.
   * @param {string[]} like   Files that include what is worth to be precompiled.
   * @param {string[]} extra  Options of clang.
   */
  compile: async ({ lesson, files, level, sources, like, extra = [] }) => {
    await precompile(headersOf(like, putOwn(lesson, files)));
    const place = (source) => {
      const mine = source.replace(/^lessons\//, "mine/");
      return get(mine) ? mine : source;
    };
    put("unit/unit.cpp", sources.map((source) => `#include "/${place(source)}"\n`).join(""));
    const { status, bytes, text } = clang([level, ...including("/precompiled.pch"), ...extra, "-c", "/unit/unit.cpp", "-o", "-"]);
    const log = text
      .replace(/^In file included from \/unit\/unit\.cpp:\d+:\n/gm, "")
      .replace(/^\d+ (?:error|warning)s?.* generated\.\n/gm, "");
    return { object: status === 0 ? bytes : null, messages: messagesOf(log, lesson), log: shortened(log) };
  },

  /** Links objects, the compiled ones and those of the pack, into a program. */
  link: ({ compiled, names, start }) => {
    compiled.forEach((bytes, i) => put(`linked/${i}.o`, bytes));
    const libraries = ["libc++.a", "libc++abi.a", "libc-printscan-long-double.a", "libc.a", "libclang_rt.builtins-wasm32.a"];
    const { status, text } = run(["wasm-ld", "-m", "wasm32", ...start, ...compiled.map((_, i) => `/linked/${i}.o`),
      ...[...names, ...libraries].map((name) => `/objects/${name}`),
      "--stack-first", "-z", "stack-size=8388608", "--max-memory=1073741824", "--strip-debug", "-o", "/linked/program.wasm"]);
    const program = status === 0 ? get("linked/program.wasm") : null;
    root.delete("linked");
    return { program, log: shortened(text) };
  },
};

async function answer(data) {
  try {
    self.postMessage({ id: data.id, ...(await tasks[data.task](data)) });
  } catch (error) {
    self.postMessage({ id: data.id, error: /memory/i.test(error.message) ? "There is not enough memory for the compiler." : error.message });
  }
}

let last = Promise.resolve();
self.onmessage = ({ data }) => (last = last.then(() => answer(data)));  // one at a time
