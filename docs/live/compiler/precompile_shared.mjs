// SPDX-License-Identifier: MIT
// Precompiles, by the compiler of the pages, what all lessons share: node precompile_shared.mjs FOLDER SEARCH_PATH.
// FOLDER is what a page fetches, and gets shared.pch.gz; SEARCH_PATH lists folders of headers, as JSON.

import { readFileSync, writeFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { gzipSync } from "node:zlib";

const [, , folder, searchPath] = process.argv;
globalThis.self = globalThis;
await import(pathToFileURL(`${folder}/compiler_worker.js`));
const { Toolchain } = await import(pathToFileURL(`${folder}/toolchain.js`));

/** Asks the compiler's worker, which here is no worker. */
const ask = (message) => new Promise((resolve, reject) => {
  self.postMessage = ({ error, ...answer }) => (error === undefined ? resolve(answer) : reject(new Error(error)));
  self.onmessage({ data: message });
});

const names = ["llvm.wasm.gz", "texts.json.gz", "objects.gz"];
const blobs = Object.fromEntries(names.map((name) => [name, new Blob([readFileSync(`${folder}/${name}`)])]));
await ask({ task: "load", blobs, searchPath: JSON.parse(searchPath) });
const toolchain = new Toolchain();
toolchain.lessons = JSON.parse(readFileSync(`${folder}/lessons.json`, "utf8"));
const files = Object.keys(toolchain.lessons).flatMap((lesson) => toolchain.likeThoseOf(lesson));
const { bytes } = await ask({ task: "precompileShared", files });
writeFileSync(`${folder}/shared.pch.gz`, gzipSync(bytes, { level: 9 }));
