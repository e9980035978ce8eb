// SPDX-License-Identifier: MIT
// What the reader has written: kept by the browser, packed as mine/, or as a part of a link.

import { deflateSync, inflateSync, strFromU8, strToU8, unzipSync, zipSync } from "fflate";

const prefix = "rasterbook ";
const largestFile = 1 << 20;  // bytes; the longest of the course has 20,000
const longestLink = 16000;  // characters, that mail and chat programs bear, too

/** @return {object?}  { files, step, begun }: what was kept under this name, if it is readable. */
export function kept(name) {
  try {
    return JSON.parse(localStorage.getItem(prefix + name));
  } catch {
    return null;
  }
}

/** @return {string}  What went wrong, or nothing. */
export function keep(name, work) {
  try {
    localStorage.setItem(prefix + name, JSON.stringify(work));
    return "";
  } catch (error) {
    return error.name === "QuotaExceededError"
      ? "The browser's storage is full: save what you have written as a file."
      : "This browser keeps nothing of this page: save what you have written as a file.";
  }
}

export function forget(name) {
  try {
    localStorage.removeItem(prefix + name);
  } catch {
    // Then nothing was kept.
  }
}

/** The lessons of which something is kept. */
export function keptLessons() {
  try {
    return Object.keys(localStorage).filter((key) => /^rasterbook \d\d_\w+$/.test(key)).map((key) => key.slice(prefix.length)).sort();
  } catch {
    return [];
  }
}

/** @param {object} folders  mine/NAME by NAME: texts by the files' names; 06_phong/phong.hpp has its own folder. */
export function zipOf(folders) {
  const inside = {};
  for (const [folder, files] of Object.entries(folders))
    for (const [name, text] of Object.entries(files)) inside[`mine/${name.includes("/") ? name : `${folder}/${name}`}`] = strToU8(text);
  return zipSync(inside, { level: 9 });
}

/**
 * @param {Uint8Array} bytes
 * @return {object}  As zipOf takes it.
 * @throws  Says why this is no folder mine/ of the course.
 */
export function foldersOf(bytes) {
  let files;
  const isSource = ({ name }) => /\.[ch]pp$/.test(name);
  try {
    files = unzipSync(bytes, { filter: (file) => isSource(file) && file.originalSize <= largestFile });
  } catch {
    throw new Error("This file is no zip that can be read.");
  }
  const folders = {};
  for (const [path, content] of Object.entries(files)) {
    const [, folder, name] = path.match(/(?:^|\/)(\d\d_\w+|sandbox)\/([\w.-]+)$/) ?? [];
    if (!folder) continue;
    try {
      (folders[folder] ??= {})[name] = new TextDecoder("utf-8", { fatal: true }).decode(content).replaceAll("\r\n", "\n");
    } catch {
      throw new Error(`${path} is no text in UTF-8.`);
    }
  }
  if (Object.keys(folders).length === 0) throw new Error("This zip has no files of a lesson, such as mine/05_textures/texture.hpp.");
  return folders;
}

/**
 * Files as a part of an address.
 *
 * @throws  If they are too long for one.
 */
export function linkPartOf(files) {
  const text = btoa(strFromU8(deflateSync(strToU8(JSON.stringify(files)), { level: 9 }), true)).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
  if (text.length > longestLink)
    throw new Error(`This would make a link of ${text.length.toLocaleString("en")} characters, too long for many programs: save it as a file.`);
  return text;
}

/** @throws  If it is not what linkPartOf made. */
export function filesOfLink(part) {
  try {
    const bytes = strToU8(atob(part.replaceAll("-", "+").replaceAll("_", "/")), true);
    const files = JSON.parse(strFromU8(inflateSync(bytes)));
    if (typeof files !== "object" || !Object.entries(files).every(([name, text]) => isFileName(name) && typeof text === "string")) throw new Error();
    return files;
  } catch {
    throw new Error("The code in this link cannot be read: perhaps its end was cut off.");
  }
}

/** Of a file that may stand beside a main.cpp, or in place of one of the course: 06_phong/phong.hpp. */
export const isFileName = (name) => /^(\w+\/)*\w[\w.-]*\.[ch]pp$/.test(name);
