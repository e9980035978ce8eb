// SPDX-License-Identifier: MIT
// What the sandbox has and a lesson's page has not: a choice of what to begin with, files that come
// and go, and a state that is a link: #start=05.1&model=crate.obj&code=...

import { button, element } from "./elements.js";
import { filesOfLink, isFileName, linkPartOf } from "./work.js";

/** Under which what is written is kept: what a link brings does not take the place of one's own. */
const nameOf = (asked, link) => `sandbox ${asked}${link ? " linked" : ""}`;
const pairsOfAddress = () => new URLSearchParams(location.hash.slice(1));

export class Sandbox {
  /** @param {object} course  { program, lessons, exercises }: see docs/site/exercises.py. */
  constructor(course) {
    this.course = course;
  }

  /** What the address asks for, as Editor takes it; and shows the exercise. */
  async start(place) {
    const address = pairsOfAddress();
    const asked = address.get("start") ?? "";
    const exercise = this.course.exercises[asked];
    const lesson = exercise?.lesson ?? Object.keys(this.course.lessons).find((name) => name.slice(0, 2) === asked);
    if (asked && !lesson) throw new Error(`There is no lesson and no exercise '${asked}'.`);
    place.before(this.choice(asked));
    if (exercise) place.before(await this.exerciseBox(asked, exercise));
    addEventListener("hashchange", () => {
      if ((pairsOfAddress().get("start") ?? "") !== asked || pairsOfAddress().get("code") !== address.get("code")) location.reload();
    });
    const ofLesson = this.course.lessons[lesson];
    const names = exercise?.files ?? ["main.cpp"];
    const files = lesson ? Object.fromEntries(names.map((name) => [name, this.textOf(name, lesson)])) : { "main.cpp": this.course.program };
    const code = address.get("code");
    return {
      name: nameOf(asked, code),
      link: code,
      asked,
      compiled: lesson ?? "sandbox",
      files,
      linked: code ? filesOfLink(code) : null,
      solution: ofLesson ?? null,
      options: exercise?.options ?? [],
    };
  }

  /** @param {string} name  Of a file of the lesson, or with its folder of any. */
  textOf(name, lesson) {
    const [folder, file] = name.includes("/") ? name.split("/") : [lesson, name];
    return this.course.lessons[folder]?.[file];
  }

  choice(asked) {
    const option = (value, textContent) => element("option", { value, textContent, selected: value === asked });
    const select = element("select", { onchange: () => (location.hash = select.value ? `start=${select.value}` : "") },
      option("", "a small program"),
      ...Object.keys(this.course.lessons).map((lesson) => {
        const number = lesson.slice(0, 2);
        const exercises = Object.keys(this.course.exercises).filter((name) => name.startsWith(`${number}.`));
        return element("optgroup", { label: `Lesson ${number}` }, option(number, `lesson ${number} as it is`), ...exercises.map((name) => option(name, `exercise ${name}`)));
      }));
    return element("div", { className: "begin" }, element("label", {}, "Begin with ", select));
  }

  /** The exercise as its lesson's page has it, with the answer behind a fold. */
  async exerciseBox(name, { lesson }) {
    const [number, which] = name.split(".");
    const page = `lesson_${number}.html`;
    const box = element("section", { className: "exercise", "aria-label": `Exercise ${name}` });
    const text = await fetch(page).then((answer) => answer.text()).catch(() => "");
    const read = new DOMParser().parseFromString(text, "text/html");
    let next = read.getElementById(`exercise_${which}`)?.nextElementSibling;
    for (; next && !next.matches("h1, h2, nav") && !next.id.startsWith("exercise_"); next = next.nextElementSibling)
      if (!next.matches(".try")) box.append(next.cloneNode(true));
    box.append(element("p", {}, element("a", { href: `${page}#exercise_${which}`, textContent: `Lesson ${lesson.slice(0, 2)}, exercise ${which}` })));
    window.renderMathInElement?.(box, { delimiters: [{ left: "\\(", right: "\\)", display: false }, { left: "\\[", right: "\\]", display: true }] });
    return box;
  }

  /** To add a file and to take one away. */
  fileBar(editor) {
    const lesson = editor.start.compiled;
    const known = Object.keys(this.course.lessons).flatMap((folder) => Object.keys(this.course.lessons[folder]).map((file) => (folder === lesson ? file : `${folder}/${file}`)));
    const list = element("datalist", { id: "known-files" }, ...known.filter((name) => !(name in editor.files) && !name.endsWith("/main.cpp")).map((value) => element("option", { value })));
    const field = element("input", { type: "text", placeholder: "shade.hpp", "aria-label": "A file's name" });
    field.setAttribute("list", list.id);
    const add = () => this.add(editor, field.value.trim());
    field.onkeydown = (event) => {
      if (event.key === "Enter") add();
    };
    return element("div", { className: "bar files adding" }, field, list, button("Add file", add), button("Remove this file", () => this.remove(editor, editor.selected)));
  }

  add(editor, name) {
    const { files } = editor;
    if (!isFileName(name)) editor.note.textContent = `'${name}' is no file's name: it has to end in .hpp or .cpp.`;
    else if (name in files) editor.note.textContent = `${name} is there already.`;
    else {
      files[name] = this.textOf(name, editor.start.compiled) ?? (name.endsWith(".hpp") ? "#pragma once\n\n" : "");
      editor.view.put(name, files[name]);
      editor.buildTabs();
      editor.select(name);
      editor.keep();
      editor.view.focus();
    }
  }

  remove(editor, name) {
    if (name === "main.cpp") editor.note.textContent = "A program needs its main.cpp.";
    else if (confirm(`Remove ${name}? What you have written there is lost.`)) {
      delete editor.files[name];
      editor.view.remove(name);
      editor.buildTabs();
      editor.select("main.cpp");
      editor.keep();
    }
  }

  putIntoAddress(files, start) {
    const code = linkPartOf(files);
    start.name = nameOf(start.asked, code);
    start.link = code;
    const others = location.hash.slice(1).split("&").filter((pair) => pair.includes("=") && !/^(start|code)=/.test(pair));
    const own = [...(start.asked ? [`start=${start.asked}`] : []), `code=${code}`];
    history.replaceState(null, "", `#${[...own, ...others].join("&")}`);
  }
}
