// SPDX-License-Identifier: MIT
// Writing a lesson in its page: files, the compiler, the tests, and what they say. The sandbox is
// the same without tests. docs/live/live.js opens it, and draws with the program that is made here.

import { CodeView } from "./code_view.js";
import { comparisonOf } from "./comparison.js";
import { button, download, element } from "./elements.js";
import { readPicture } from "./read_picture.js";  // of ../compiler
import { Sandbox } from "./sandbox.js";
import { foldersOf, forget, keep, kept, keptLessons, zipOf } from "./work.js";

const pause = 1500;  // ms without a key, after which the program is made
const mostMessages = 30;
const of = (path) => new URL(`../compiler/${path}`, import.meta.url);

class Editor {
  /**
   * @param {Element} place    The page's .live, with setProgram and drawPicture.
   * @param {object} start     { name, compiled, files, steps, solution, options }: what is kept and
   *                           compiled under which name, the files of the beginning, and for a
   *                           lesson its steps and the course's files.
   * @param {Sandbox?} sandbox  Or null in a lesson's page.
   */
  constructor(place, start, sandbox) {
    this.place = place;
    this.start = start;
    this.sandbox = sandbox;
    this.toolchain = null;
    this.runs = 0;  // counts them: what an older one finds is of no use
    this.steps = start.steps ?? [];
    this.build();
    let before = kept(start.name);
    if (before && !Object.values(before.files ?? {}).every((text) => typeof text === "string")) before = null;
    const isOfThisLink = !start.link || before?.link === start.link;
    this.take((isOfThisLink && before?.files) || start.linked || start.files, before?.step ?? (this.steps.length > 0 ? 1 : 0), before?.begun ?? {});
  }

  // --- The page's parts

  build() {
    this.tabs = element("div", { className: "tabs", role: "tablist", "aria-label": "Files" });
    this.runButton = button("Run", () => this.run(), { className: "run", title: "Ctrl+Enter" });
    this.stopButton = button("Stop", () => this.stop(), { disabled: true });
    this.auto = element("input", { type: "checkbox", onchange: () => this.wait() });
    this.stepChoice = element("select", { onchange: () => this.chooseStep(+this.stepChoice.value) },
      ...this.steps.map(({ title }, i) => element("option", { value: i + 1, textContent: `Step ${i + 1} of ${this.steps.length}: ${title}` })),
      element("option", { value: 0, textContent: "The whole lesson" }));
    this.solution = button(this.sandbox ? "What you changed" : "Course's solution", () => this.toggleSolution(), { "aria-pressed": "false" });
    this.file = element("input", { type: "file", accept: ".zip", hidden: true, onchange: () => this.load() });
    const again = [
      ...(this.steps.length > 0 ? [button("Start the step again", () => this.startAgain(true))] : []),
      button(this.sandbox ? "Start again" : "Start the lesson again", () => this.startAgain(false)),
    ];
    const head = element("div", { className: "bar" }, this.runButton, this.stopButton,
      element("label", {}, this.auto, " Run when I pause"),
      ...(this.steps.length > 0 ? [element("label", { className: "step" }, "Write ", this.stepChoice)] : []));
    const foot = element("div", { className: "bar files" },
      button("Save as mine.zip", () => this.save()), button("Load …", () => this.file.click()), this.file, ...again,
      ...(this.start.solution ? [this.solution] : []),
      ...(this.sandbox ? [button("Copy link", () => this.copyLink())] : [button("Close", () => this.close())]));
    this.code = element("div", { className: "code", role: "tabpanel" });
    this.view = new CodeView(this.code, { changed: (name, text) => this.changed(name, text), run: () => this.run() });
    const keys = element("p", { className: "keys", id: "editor-keys", textContent: "Ctrl+Enter runs, Ctrl+F finds. Tab indents; Escape, then Tab, leaves the code." });
    this.note = element("p", { className: "note", role: "status" });

    this.status = element("p", { className: "outcome" });
    this.progress = element("progress", { hidden: true, max: 1, "aria-label": "Fetched of the compiler" });
    this.tiers = element("ul", { className: "tiers" });
    this.onward = button("", () => this.goOn(), { hidden: true, className: "run" });
    this.messages = element("ol", { className: "messages", "aria-label": "What the compiler says" });
    this.log = element("pre", { hidden: true, tabIndex: 0, "aria-label": "What the compiler prints" });
    this.failure = element("pre", { className: "failure", hidden: true, tabIndex: 0, "aria-label": "The first failure" });
    this.toPictures = button("Compare the pictures", () => this.compared.scrollIntoView({ block: "center" }), { hidden: true });
    this.compared = element("div", { className: "comparison", hidden: true });
    const results = element("section", { className: "results", "aria-label": "What came of it" },
      element("div", { role: "status" }, this.status, this.tiers), this.progress, this.onward, this.messages, this.log, this.failure, this.toPictures);
    const panel = element("section", { className: "editor", "aria-label": "Write it yourself" },
      head, this.tabs, this.code, keys, foot, this.note, this.compared);
    this.parts = [results, panel];
    this.place.querySelector(".said").after(...this.parts);
    this.place.classList.add("writing");
  }

  /** Takes the place of all that was there. */
  take(files, step, begun) {
    this.files = { ...files };
    this.step = step;
    this.begun = begun;
    this.stepChoice.value = step;
    this.view.open(this.files);
    this.hideSolution();
    this.buildTabs();
    const names = Object.keys(this.files);
    this.select(names.find((name) => name !== "main.cpp" && this.files[name].includes("TODO")) ?? names[0]);
    this.clear(this.sandbox ? "Run compiles this and draws." : "Run compiles this, draws, and tests it.");
  }

  buildTabs() {
    this.tabs.replaceChildren();
    for (const name of Object.keys(this.files)) {
      const tab = button(name, () => this.select(name), { role: "tab", id: `tab-${name}`, onkeydown: (event) => this.tabKey(event, name) });
      this.tabs.append(tab);
    }
    this.place.querySelector(".editor .adding")?.remove();
    if (this.sandbox) this.place.querySelector(".editor .keys").after(this.sandbox.fileBar(this));
  }

  tabKey(event, name) {
    const names = Object.keys(this.files);
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (event.key === "Delete" && this.sandbox) this.sandbox.remove(this, name);
    if (!step) return;
    event.preventDefault();
    this.select(names[(names.indexOf(name) + step + names.length) % names.length]);
    this.tabs.querySelector("[aria-selected=true]").focus();
  }

  select(name) {
    this.selected = name;
    for (const tab of this.tabs.children) {
      const isThis = tab.textContent === name;
      tab.setAttribute("aria-selected", isThis);
      tab.tabIndex = isThis ? 0 : -1;
      if (isThis) this.code.setAttribute("aria-labelledby", tab.id);
    }
    const course = this.start.solution?.[name] ?? this.sandbox?.textOf(name, this.start.compiled) ?? "";
    const both = this.sandbox ? [course, this.files[name]] : [this.files[name], course];
    if (this.isSolutionShown) this.view.showDifference(name, ...both);
    else this.view.show(name);
  }

  clear(words = "") {
    this.say(words);
    this.progress.hidden = true;
    this.onward.hidden = true;
    this.tiers.replaceChildren();
    this.messages.replaceChildren();
    this.failure.hidden = this.log.hidden = this.compared.hidden = this.toPictures.hidden = true;
  }

  say(words, kind = "") {
    this.status.textContent = words;
    this.status.dataset.kind = kind;
  }

  // --- What is written

  changed(name, text) {
    this.files[name] = text;
    this.keep();
    this.wait();
  }

  keep() {
    const wrong = keep(this.start.name, { files: this.files, step: this.step, begun: this.begun, link: this.start.link });
    if (wrong || this.note.textContent.includes("storage")) this.note.textContent = wrong;
  }

  wait() {
    clearTimeout(this.timer);
    if (this.auto.checked) this.timer = setTimeout(() => this.run(), pause);
  }

  chooseStep(step) {
    this.step = step;
    this.begun[step] ??= { ...this.files };
    this.keep();
    this.isNewStep = true;
    this.run();
  }

  goOn() {
    this.stepChoice.value = this.step < this.steps.length ? this.step + 1 : 0;
    this.chooseStep(+this.stepChoice.value);
    this.view.focus();
  }

  startAgain(isStep) {
    const files = (isStep && this.begun[this.step]) || this.start.files;
    const what = !isStep ? "from the beginning" : this.step > 0 ? `step ${this.step}` : "with the whole lesson";
    if (!confirm(`Start ${what} anew? What you have written ${isStep ? "since then " : ""}is lost, unless you have saved it.`)) return;
    this.stop();
    if (!isStep) forget(this.start.name);
    this.take(files, isStep ? this.step : Math.min(this.steps.length, 1), isStep ? this.begun : {});
    if (isStep) this.keep();
    if (!this.sandbox) this.place.setProgram(null);
  }

  toggleSolution() {
    this.isSolutionShown = !this.isSolutionShown;
    this.solution.setAttribute("aria-pressed", this.isSolutionShown);
    this.select(this.selected);
    const [green, red] = this.sandbox ? ["yours", "the course's"] : ["the course's", "yours"];
    this.note.textContent = this.isSolutionShown ? `Green is in ${green} alone, red in ${red}. The same button goes back to your file.` : "";
  }

  hideSolution() {
    this.isSolutionShown = false;
    this.solution.setAttribute("aria-pressed", "false");
  }

  save() {
    const all = Object.fromEntries(keptLessons().map((name) => [name, kept(name)?.files ?? {}]));
    const folder = this.start.compiled;
    download(zipOf(this.sandbox ? { [folder]: this.files } : { ...all, [folder]: this.files }), "mine.zip", "application/zip");
    this.note.textContent = folder === "sandbox"
      ? "Load takes mine.zip back."
      : "Unpacked in the course's folder, mine.zip is its folder mine/, for ./lessons/run --mine. Load takes it back.";
  }

  async load() {
    const [file] = this.file.files;
    this.file.value = "";
    if (!file) return;
    try {
      const folders = foldersOf(new Uint8Array(await file.arrayBuffer()));
      const names = Object.keys(folders);
      let here = folders[this.start.compiled];
      if (!here && this.sandbox) throw new Error(`${file.name} has no files of ${this.start.compiled}.`);
      if (!confirm(`Take ${names.join(", ")} from ${file.name}, in place of what this browser has of ${names.length > 1 ? "them" : "it"}?`)) return;
      if (!this.sandbox)
        for (const name of names)
          if (name !== this.start.compiled && name !== "sandbox") keep(name, { files: folders[name], begun: {} });
      if (this.sandbox)
        for (const name of names)
          if (name !== this.start.compiled)
            for (const [other, text] of Object.entries(folders[name])) here = { ...here, [`${name}/${other}`]: text };
      if (here) {
        this.stop();
        this.take(this.sandbox ? here : { ...this.start.files, ...here }, this.step, this.begun);
        this.keep();
      }
      this.note.textContent = `Loaded: ${names.join(", ")}.`;
    } catch (error) {
      this.note.textContent = error.message;
    }
  }

  async copyLink() {
    try {
      this.sandbox.putIntoAddress(this.files, this.start);
      this.keep();
      await navigator.clipboard.writeText(location.href);
      this.note.textContent = "The link is copied; it is this page's address, too.";
    } catch (error) {
      this.note.textContent = error.name === "NotAllowedError" ? "The link is this page's address now." : error.message;
    }
  }

  close() {
    this.stop();
    clearTimeout(this.timer);
    this.parts.forEach((part) => part.remove());
    this.place.classList.remove("writing");
    this.place.setProgram(null);
    this.place.dispatchEvent(new Event("editorclosed"));
  }

  // --- Running it

  stop() {
    ++this.runs;
    clearTimeout(this.timer);
    if (!this.isRunning) return;
    this.toolchain?.stop();
    this.say("Stopped.");
    this.setRunning(false);
  }

  setRunning(isRunning) {
    this.isRunning = isRunning;
    this.place.dataset.run = isRunning ? "running" : "done";
    this.stopButton.disabled = !isRunning;
    this.progress.hidden = true;
  }

  /** Compiles, draws and tests; a newer run ends an older one. */
  async run() {
    this.stop();
    const run = this.runs;
    const isOld = () => run !== this.runs;
    if (this.isSolutionShown) this.toggleSolution();
    this.clear();
    this.setRunning(true);
    try {
      await this.make(isOld);
    } catch (error) {
      if (!isOld()) this.say(error.message, "wrong");
    }
    if (!isOld()) this.setRunning(false);
  }

  async make(isOld) {
    const begun = performance.now();
    const seconds = () => `${((performance.now() - begun) / 1000).toFixed(1)} s`;
    await this.getToolchain(isOld);
    if (isOld()) return;
    this.say("Compiling …");
    const asked = [this.start.compiled, { ...this.files }];
    const compiled = this.toolchain.compile(...asked);
    const drawn = new Promise((resolve) => this.place.addEventListener("drawn", resolve, { once: true }));
    const tests = this.sandbox ? null : this.toolchain.test(...asked, this.step || null, drawn);
    tests?.catch(() => {});  // nobody may wait for them
    const { messages, log, program } = await compiled;
    if (isOld()) return;
    this.show(messages, log, program);
    const warnings = messages.filter(({ severity }) => severity === "warning").length;
    const warned = warnings > 0 ? ` with ${counted(warnings, "warning")}` : "";
    if (!program) {
      const errors = messages.filter(({ severity }) => severity === "error").length;
      const whose = this.hasDrawn ? "" : " The picture is still the course's.";
      return this.say(`It does not compile${errors > 0 ? `: ${counted(errors, "error")}` : ""}${warned}.${whose}`, "wrong");
    }
    const options = this.optionsToDraw();
    this.isNewStep = false;
    await this.place.setProgram(program, options);
    if (isOld()) return;
    if (this.sandbox) return this.say(`Compiled${warned} in ${seconds()}.`, "right");
    this.say(`Compiled${warned} in ${seconds()}. Testing …`);
    const { tiers, first, ...tested } = await tests;
    if (isOld()) return;
    if (tested.messages?.length > 0 && tiers.length === 0) {  // main.cpp compiles, but the tests' view of a header does not
      this.show(tested.messages, tested.log, null);
      return this.say("The tests do not compile with this.", "wrong");
    }
    this.report(tiers, first, `compiled and tested in ${seconds()}`);
    if (first?.picture) await this.compare(first.picture, isOld);
  }

  async getToolchain(isOld) {
    if (!this.toolchain) {
      this.say("Looking for the compiler …");
      const { Toolchain } = await import(of("toolchain.js")).catch(() => {
        throw new Error("The compiler cannot be read: this site was made without it.");
      });
      this.toolchain = new Toolchain();
    }
    await this.toolchain.load(({ bytes, of: all, what }) => {
      if (isOld()) return;
      this.progress.hidden = false;
      this.progress.value = all > 0 ? bytes / all : 0;
      const inMb = (size) => (size / 1e6).toFixed(size < 1e7 ? 1 : 0);
      this.say(`Fetching ${what}: ${inMb(bytes)} of ${inMb(all)} MB, once for all lessons`);
    });
    this.progress.hidden = true;
  }

  /** Of a step when it is begun; later the reader's own choice stays. */
  optionsToDraw() {
    if (this.sandbox) return this.hasDrawn ? null : ((this.hasDrawn = true), this.start.options ?? []);
    if (this.hasDrawn && !this.isNewStep) return null;
    this.hasDrawn = true;
    return this.step > 0 ? this.steps[this.step - 1].options : [];
  }

  /** What the compiler says, at its lines and as a list. */
  show(messages, log, program) {
    this.view.mark(messages);
    this.messages.replaceChildren(...messages.slice(0, mostMessages).map(({ file, line, column, severity, text }) => {
      const isHere = file in this.files;
      const words = [element("b", { className: severity, textContent: severity }), ` ${text}`];
      const where = file ? `${file}:${line}:${column}` : "";
      if (!isHere) return element("li", {}, element("code", { textContent: where }), " ", ...words);
      return element("li", {}, button(where, () => {
        this.select(file);
        this.view.goTo(line, column);
      }), " ", ...words);
    }));
    if (messages.length > mostMessages) this.messages.append(element("li", { textContent: `and ${counted(messages.length - mostMessages, "more message", "more messages")}` }));
    this.log.hidden = program !== null || !log || messages.length > 0;
    this.log.textContent = log ?? "";
  }

  report(tiers, first, how) {
    const isAll = tiers.length > 0 && tiers.every(({ passed, total }) => passed === total) && !first;
    this.tiers.replaceChildren(...tiers.map(({ name, passed, total }) => {
      const bar = element("meter", { min: 0, max: Math.max(total, 1), value: passed, "aria-label": name });
      return element("li", { className: passed === total ? "right" : "" }, element("span", { textContent: `${name} ${passed} of ${total}` }), bar);
    }));
    const number = this.start.name.slice(0, 2);
    const what = this.step > 0 ? `Step ${this.step}` : `Lesson ${number}`;
    const isUntouched = this.files["main.cpp"] === this.start.files["main.cpp"] && this.files["main.cpp"] !== this.start.solution["main.cpp"];
    const remind = (word) => this.status.append(` ${word} main.cpp is still lesson ${this.start.before.slice(0, 2)}'s: see `,
      element("a", { href: "#what-changes-in-maincpp", textContent: "what changes in it" }), ".");
    if (isAll) {
      const next = this.step > 0 && this.step < this.steps.length ? `Go on to step ${this.step + 1}` : this.step > 0 ? "Test the whole lesson" : "";
      this.say(`${what} is done; ${how}.`, "right");
      if (isUntouched) remind("But");
      const hasThreads = this.steps.slice(0, this.step || this.steps.length).some((step) => step.hasThreads);
      const elsewhere = next ? "Threads" : hasThreads ? "Threads and the hard cases" : "The hard cases";
      if (hasThreads || !next) this.status.append(` ${elsewhere} are tested on the command line: `, element("code", { textContent: `./tests/run --mine ${number}` }));
      this.onward.textContent = next;
      this.onward.hidden = next === "";
    } else {
      this.say(`${what} is not done yet; ${how}.`, "wrong");
      if (isUntouched && first?.picture) remind("And");
    }
    this.failure.hidden = !first;
    if (first) this.failure.replaceChildren(...withLink(first.text));
  }

  async compare({ name, options, golden }, isOld) {
    const expected = await readPicture(of(`golden/${golden}`));
    const own = new ImageData(await this.place.drawPicture(options, [expected.width, expected.height]), expected.width, expected.height);
    if (isOld()) return;
    const box = this.compared;
    box.replaceChildren(element("h3", { textContent: `${name}${options.length > 0 ? `, drawn with ${options.join(" ")}` : ""}` }), ...comparisonOf(expected, own));
    box.hidden = this.toPictures.hidden = false;
    const looks = await this.toolchain.diagnose(this.start.compiled, own.data, expected.data, expected.width, expected.height);
    if (!isOld() && looks) box.append(element("p", { className: "looks", textContent: looks }));
  }
}

/** A failure's text, in which the equation to read is a link to it. */
function withLink(text) {
  const found = text.match(/^To read: (docs\/derivations\/(\d\d)_\w+\.md, .*?(\d+)\.(\d+).*)$/m);
  if (!found) return [text];
  const [line, place, lesson, chapter, equation] = found;
  const begin = found.index + line.length - place.length;
  const page = chapter === "7" && equation > 14 ? "toon_materials" : `derivation_${lesson}`;
  const link = element("a", { href: `${page}.html#eq_${chapter}_${equation}`, textContent: place });
  return [text.slice(0, begin), link, text.slice(begin + place.length)];
}

const counted = (count, one, many = `${one}s`) => `${count} ${count === 1 ? one : many}`;

async function readJson(url, otherwise) {
  const answer = await fetch(url).catch(() => null);
  if (!answer?.ok) throw new Error(otherwise);
  return answer.json();
}

/** @param {Element} place  The page's .live. */
export async function open(place) {
  const name = place.dataset.lesson;
  const style = element("link", { rel: "stylesheet", href: new URL("editor.css", import.meta.url).href });
  const isStyled = new Promise((resolve) => (style.onload = style.onerror = resolve));
  document.head.append(style);
  let start, sandbox = null;
  if (name === "sandbox") {
    sandbox = new Sandbox(await readJson(new URL("exercises.json", import.meta.url), "The sandbox's files cannot be read: make the site anew with ./docs/run."));
    start = await sandbox.start(place);
  } else {
    const lessons = await readJson(of("lessons.json"), "The compiler cannot be read: this site was made without it.");
    if (!lessons[name]) throw new Error("This lesson cannot be written in its page: what it needs is not in a browser.");
    const { starter, ...rest } = lessons[name];
    start = { ...rest, name, compiled: name, files: starter };
  }
  await isStyled;
  const editor = new Editor(place, start, sandbox);
  if (!sandbox) editor.view.focus();
}
