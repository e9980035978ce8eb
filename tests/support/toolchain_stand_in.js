// SPDX-License-Identifier: MIT
// In place of the site's compiler, for tests of the editor: it answers at once. The program is the
// lesson's own, from the site; what is said depends on words in the files. "PROGRAM NAME" asks for
// another program.

const wait = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

async function programOf(lesson, files) {
  const [, other] = Object.values(files).join("\n").match(/PROGRAM (\w+)/) ?? [];
  if (other) return new Uint8Array(await (await fetch(new URL(`${other}.wasm`, import.meta.url))).arrayBuffer());
  const script = await (await fetch(new URL(`../${lesson === "sandbox" ? "02_triangle_fill" : lesson}.js`, import.meta.url))).text();
  const [, text] = script.match(/= "(.*)";/);
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  return new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer());
}

export class Toolchain {
  constructor() {
    window.standIn = { runs: 0, stops: 0 };
    this.waiting = new Set();
  }

  async load(progress) {
    if (this.isLoaded) return;
    for (let part = 0; part <= 4; ++part) {
      progress({ bytes: part * 8e6, of: 32e6, what: "the compiler" });
      await wait(60);
    }
    this.isLoaded = true;
  }

  until(ms) {
    return new Promise((resolve, reject) => {
      this.waiting.add(() => reject(Object.assign(new Error("Stopped."), { name: "AbortError" })));
      setTimeout(resolve, ms);
    });
  }

  async compile(lesson, files) {
    ++window.standIn.runs;
    window.standIn.last = { lesson, files };
    const all = Object.entries(files);
    const messages = [];
    for (const [file, text] of all)
      text.split("\n").forEach((code, i) => {
        for (const severity of ["error", "warning"])
          if (code.includes(`#${severity}`)) messages.push({ file, line: i + 1, column: code.indexOf("#") + 2, severity, text: code.split(`#${severity} `)[1] ?? severity });
      });
    await this.until(all.some(([, text]) => text.includes("SLOW")) ? 60000 : 50);
    if (all.some(([, text]) => text.includes("NO TOOLCHAIN"))) throw new Error("There is not enough memory for the compiler.");
    const isWrong = messages.some(({ severity }) => severity === "error");
    return { messages, log: "", program: isWrong ? null : await programOf(lesson, files) };
  }

  async test(lesson, files, step) {
    window.standIn.step = step;
    await this.until(50);
    const isDone = !Object.values(files).some((text) => text.includes("TODO"));
    const tiers = [{ name: "formulas", passed: isDone ? 9 : 5, total: 9 }, { name: "pictures", passed: isDone ? 1 : 0, total: 1 }];
    const first = isDone ? null : {
      text: "FAILED Lines.PictureOfTheLesson\nTo read: docs/derivations/01_bresenham_lines.md, Eq. 1.3\ntests/01_bresenham_lines_test.cpp:112: 1,234 pixels differ; the first is pixel 10, 20: yours 0 0 0, expected 12 13 14",
      picture: { name: "PictureOfTheLesson", options: ["--paint", "barycentric"], golden: `${lesson}.png` },
    };
    return { messages: [], log: "", tiers, first };
  }

  async diagnose(lesson, own, expected, width, height) {
    const at = 4 * (width * (height >> 1) + (width >> 1));
    return `In the middle ${own.slice(at, at + 3)}, expected ${expected.slice(at, at + 3)}.`;
  }

  stop() {
    ++window.standIn.stops;
    for (const reject of this.waiting) reject();
    this.waiting.clear();
  }
}
