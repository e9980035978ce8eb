// SPDX-License-Identifier: MIT
// A lesson's page draws its picture itself. What the address says after # is what the
// controls say: #filter=nearest&against=trilinear compares two values of an option.
// The editor (docs/live/editor) puts the reader's program in the place of the lesson's.

const place = document.querySelector(".live");
const still = place.closest(".contents").querySelector("img");
const lessonName = place.dataset.lesson;
const sizes = ["480x270", "640x360", "960x540", "1280x720", "1920x1080"];
const usualSize = "1280x720";
const models = place.dataset.models.split(" ");
const unavailable = {
  "--threads": "A page draws with one thread.",
  "--keep-going": "All images of the page's scenes can be read.",
};
const viewOptions = ["--samples", "--yaw", "--pitch", "--distance", "--fov", "--depth"];
/** Options that later lessons have, too, by the lesson that brings them. */
const inherited = {
  "05": "filter wrap srgb keep-going",
  "06": "light two-sided all-effects",
  "08": "frame orthonormal handedness normal-map green normal-format channels bits",
  "09": "shadow-size bias pcf",
  10: "threads split tile show-threads",
  11: "quality camera",
  12: "explain",
  13: "show max-ids shadow-part",
};
const onlyHow = "It decides how the picture is computed, not what it shows.";
const whyNoChange = {
  "--split": onlyHow,
  "--tile": onlyHow,
  "--max-ids": onlyHow,
  "--shadow-part": onlyHow,
  "--width": onlyHow,
  "--all-effects": "It computes what cannot be seen, too.",
  "--explain": "It says what was done, below.",
};

const isSandbox = lessonName === "sandbox";  // a page without a program of its own
const ofEditor = ["start", "code"];  // what an address says to the editor
const longestRun = 10000;  // ms that a reader's program may take for an answer

let lesson = null;  // { model, controls }
let own = null;  // the reader's program, if it is what draws
let model = "";
let size = usualSize;  // of a picture that stands still
let sides = [{}, {}];  // what differs from the lesson's presets, left and right
let mode = "picture";  // or "compare", "difference"
let gain = 8;
let probed = null;  // a pixel: [x, y]
let probedSide = 0;
let pictures = [];  // the last answers, for each side

// --- The page's parts

const element = (tag, values = {}, ...children) => {
  const made = Object.assign(document.createElement(tag), values);
  made.append(...children);
  return made;
};
const labelled = (made, label) => {
  made.setAttribute("aria-label", label);
  return made;
};
const canvases = [0, 1].map(() => element("canvas"));
const handle = labelled(element("input", { type: "range", className: "split", min: 0, max: 100, step: 0.5, value: 50 }), "The border between left and right");
const cross = element("div", { className: "cross", hidden: true });
const tags = ["left", "right"].map((className) => element("span", { className: `tag ${className}` }));
const stage = element("div", { className: "stage", hidden: true }, ...canvases, cross, ...tags, handle);
const status = element("p", { className: "status" });
status.setAttribute("role", "status");
const stop = element("button", { type: "button", textContent: "Stop", hidden: true });
const printed = element("pre", { className: "printed", hidden: true });
const reasons = element("pre", { className: "reasons", tabIndex: 0 });
const close = element("button", { type: "button", textContent: "Close" });
const probeBox = element("section", { className: "probe", hidden: true }, element("div", { className: "said" }, element("h3", { textContent: "Why this pixel?" }), close), reasons);
labelled(probeBox, "Why this pixel?");
const modelChoice = element("select", {}, ...models.map((name) => element("option", { textContent: name })));
const sizeChoice = element("select", {}, ...sizes.map((value) => element("option", { value, textContent: value.replace("x", " × ") })));
const modeChoice = element("select", {}, ...[["picture", "Picture"], ["compare", "Compare"], ["difference", "Difference"]].map(([value, text]) => element("option", { value, textContent: text })));
const gainChoice = element("select", {}, ...[1, 2, 4, 8, 16, 32, 64].map((value) => element("option", { value, textContent: `× ${value}` })));
const gainLabel = element("label", {}, "Enlarged ", gainChoice);
const presets = element("select", {}, ...[["", "its own settings"], ["lesson", "as the lesson draws it"], ["samples", "with 16 samples a pixel"]].map(([value, text]) => element("option", { value, textContent: text })));
const presetLabel = element("label", {}, "Right side ", presets);
const reset = element("button", { type: "button", textContent: "Reset" });
const bar = element("div", { className: "bar" }, element("label", {}, "Scene ", modelChoice), element("label", {}, "Size ", sizeChoice), element("label", {}, "Show ", modeChoice), gainLabel, presetLabel, reset);
const groups = [`Options of this ${isSandbox ? "program" : "lesson"}`, "Camera and samples", "Options of earlier lessons"].map((title, i) =>
  element("details", { open: i === 0 && innerWidth >= 768 }, element("summary", { textContent: title }), element("div", { className: i === 0 ? "options own" : "options" })));
const commands = element("div", { className: "commands" });

// --- The worker

const url = URL.createObjectURL(new Blob([workerSource], { type: "text/javascript" }));
let worker = null;
let waiting = new Map();  // by id: what takes the answer
let lastId = 0;
let given = new Map();  // by name: what a worker has to be given first

function startWorker(whyStopped) {
  worker?.terminate();
  for (const { reject } of waiting.values()) reject(new Error(whyStopped));
  waiting.clear();
  given.clear();
  worker = new Worker(url);
  worker.onmessage = ({ data }) => {
    const { resolve, reject } = waiting.get(data.id);
    waiting.delete(data.id);
    if (data.error) reject(new Error(data.error));
    else resolve(data);
  };
  worker.onerror = (event) => {
    event.preventDefault();
    startWorker("The part of the page that draws has ended; any change starts it again.");
  };
}

function ask(task, values) {
  const answer = new Promise((resolve, reject) => {
    waiting.set(++lastId, { resolve, reject });
    worker.postMessage({ id: lastId, task, ...values });
  });
  if (!own) return answer;
  const asked = worker;
  const tooLong = setTimeout(() => {
    if (worker === asked) startWorker(`Your program did not end within ${longestRun / 1000} seconds and was stopped: perhaps a loop never ends.`);
  }, longestRun);
  return answer.finally(() => clearTimeout(tooLong));
}

/** What the script live/NAME.js has, loaded at most once: pages opened from a folder may load nothing else. */
const scripts = new Map();
function textOf(name) {
  if (!scripts.has(name))
    scripts.set(name, new Promise((resolve, reject) => {
      const script = element("script", { src: `live/${encodeURIComponent(name)}.js` });
      script.onload = () => resolve(script.remove() ?? window.liveTexts[name]);
      script.onerror = () => {
        scripts.delete(name);
        reject(new Error(`${script.src} cannot be read.`));
      };
      document.head.append(script);
    }));
  return scripts.get(name);
}

function give(task, name) {
  const asked = async () => ask(task, { name, ...(name === "own" ? { bytes: own } : { text: await textOf(name) }) });
  if (!given.has(name))
    given.set(name, asked().catch((error) => {
      given.delete(name);
      throw error;
    }));
  return given.get(name);
}

// --- Drawing

let isBusy = false;
let wanted = null;  // what is to be drawn next
let whole = 0;  // a timer: the picture is drawn in full when nothing has changed for a while
let busySince = 0;

/** @param {boolean} isMoving  Then a smaller picture will do, if a whole one takes long. */
function draw(isMoving = false, changed = "") {
  clearTimeout(whole);
  wanted = { isMoving, changed };
  place.dataset.state = "drawing";
  if (isBusy && performance.now() - busySince > 3000) startWorker("Stopped.");  // not for what nobody waits for
  if (!isBusy) drawWanted();
}

const programName = () => (own ? "own" : lessonName);
const wholeSize = () => size.split("x").map(Number);

/** The largest that takes 50 ms at most, as far as one can tell, but at least 480 pixels wide if the whole is. */
function movingSize() {
  const [width, height] = wholeSize();
  const ms = shownSides().reduce((sum, side) => sum + (pictures[side]?.wholeMs ?? 0), 0);
  const parts = [1, 3 / 4, 1 / 2, 3 / 8].filter((part) => part === 1 || width * part >= 480);
  const share = parts.find((part) => ms * part * part < 50) ?? parts.at(-1);
  return [Math.round(width * share), Math.round(height * share)];
}

const isCompared = () => mode !== "picture";
const shownSides = () => (isCompared() ? [0, 1] : [0]);

async function drawWanted() {
  const { isMoving, changed } = wanted;
  const drawnFor = mode;
  wanted = null;
  isBusy = true;
  busySince = performance.now();
  const slow = setTimeout(() => {
    say("Drawing …");
    stop.hidden = false;
  }, 700);
  try {
    await give("lesson", programName());
    await give("scene", model);
    const pixels = isMoving ? movingSize() : wholeSize();
    for (const side of shownSides()) {
      const before = pictures[side];
      const answer = await ask("draw", { side, name: programName(), model, settings: sides[side], size: pixels });
      answer.size = pixels;
      answer.wholeMs = isMoving ? before?.wholeMs ?? answer.ms : answer.ms;
      answer.isSame = changed !== "" && before?.pixels.length === answer.pixels.length && before.pixels.every((value, i) => value === answer.pixels[i]);
      pictures[side] = answer;
    }
    clearTimeout(slow);
    stop.hidden = true;
    if (isMoving) {
      setTimeout(() => mode === drawnFor && show());  // the worker gets what is wanted next before that
      cross.hidden = true;
      whole = setTimeout(draw, 200);
    } else {
      show();
      report(changed);
      await explain();
      if (!wanted) place.dataset.state = "ready";
      await timeAgain(changed);
    }
  } catch (error) {
    if (!wanted) {
      say(error.message, true);
      place.dataset.state = "failed";
    }
  }
  clearTimeout(slow);
  stop.hidden = true;
  isBusy = false;
  place.dispatchEvent(new Event("drawn"));
  if (wanted) drawWanted();
}

/** Why the probed pixel has its colour, with a link for each equation. */
async function explain() {
  probeBox.hidden = cross.hidden = !probed;
  if (!probed) return;
  const [width, height] = wholeSize();
  const [x, y] = probed;
  cross.style.left = `${(100 * (x + 0.5)) / width}%`;
  cross.style.top = `${(100 * (y + 0.5)) / height}%`;
  const { text } = await ask("probe", { side: probedSide, pixel: probed });
  reasons.replaceChildren(...text.trimEnd().split(/(Eq\. \d+\.\d+)/).map((part) => {
    const [, lesson, number] = part.match(/^Eq\. (\d+)\.(\d+)$/) ?? [];
    const page = lesson === "7" && number > 14 ? "toon_materials" : `derivation_${lesson?.padStart(2, "0")}`;
    return lesson ? element("a", { textContent: part, href: `${page}.html#eq_${lesson}_${number}` }) : part;
  }));
}

/** A program's first pictures are slow, until the browser has optimised it: times are of several, by turns. */
async function timeAgain(changed) {
  if (own) return;  // its tests are to come soon
  const times = [[], []];
  const end = performance.now() + 1500;
  for (let i = 0; i < 5 && performance.now() < end; ++i)
    for (const side of shownSides()) {
      if (wanted) return;
      busySince = performance.now();
      const { ms } = await ask("draw", { side, name: programName(), model, settings: sides[side], size: wholeSize() });
      times[side].push(ms);
    }
  for (const side of shownSides()) pictures[side].ms = pictures[side].wholeMs = median(times[side]);
  if (!wanted) report(changed);
}

const median = (values) => values.sort((a, b) => a - b)[values.length >> 1];

function put(canvas, { pixels, size }) {
  [canvas.width, canvas.height] = size;
  canvas.getContext("2d", { willReadFrequently: true }).putImageData(new ImageData(pixels, ...size), 0, 0);
}

/** How much two pictures differ: the root of the mean square of the 8-bit values, and the share of pixels. */
function differenceOf([left, right]) {
  const enlarged = new Uint8ClampedArray(left.pixels.length);
  let squares = 0;
  let pixels = 0;
  for (let i = 0; i < enlarged.length; i += 4) {
    let isOther = false;
    for (let c = i; c < i + 3; ++c) {
      const difference = Math.abs(left.pixels[c] - right.pixels[c]);
      squares += difference * difference;
      isOther ||= difference > 0;
      enlarged[c] = gain * difference;
    }
    enlarged[i + 3] = 255;
    if (isOther) ++pixels;
  }
  return { rms: Math.sqrt((squares / enlarged.length) * (4 / 3)), share: (4 * pixels) / enlarged.length, pixels: enlarged, size: left.size };
}

function show() {
  if (mode === "difference") put(canvases[0], differenceOf(pictures));
  else put(canvases[0], pictures[0]);
  if (mode === "compare") put(canvases[1], pictures[1]);
  canvases[1].hidden = handle.hidden = mode !== "compare";
  tags.forEach((tag, i) => {
    tag.textContent = differing(i);
    tag.hidden = mode !== "compare" || tag.textContent === "";
  });
  placeSplit();
  stage.hidden = false;
  if (still) still.hidden = true;
}

/** In what a side differs from the other one, in words. */
function differing(side) {
  return lesson.controls
    .map(({ name, preset }) => [name, sides[side][name] ?? preset, sides[1 - side][name] ?? preset])
    .filter(([, own, other]) => own !== other)
    .map(([name, own]) => `${bare(name)} ${own}`)
    .join(", ");
}

function placeSplit() {
  stage.style.setProperty("--split", `${handle.value}%`);
}

function say(text, isWrong = false) {
  status.textContent = text;
  status.classList.toggle("wrong", isWrong);
}

const inMs = (ms) => `${ms < 10 ? ms.toFixed(1) : Math.round(ms)} ms`;

function report(changed) {
  const [left, right] = pictures;
  const words = [`${left.size.join(" × ")} pixels in ${inMs(left.ms)}`];
  if (isCompared()) {
    const { rms, share } = differenceOf(pictures);
    words[0] = `Left ${inMs(left.ms)}, right ${inMs(right.ms)}.`;
    words.push(share === 0 ? "No pixel differs." : `${percent(share)} of the pixels differ, by ${rms.toPrecision(2)} of 255 (RMS of all).`);
  } else {
    words[0] += ` in this browser, by ${own ? "your program" : "one thread"}.`;
    if (lesson.hasProbe && !probed) words.push(`${canTurn() ? "Drag to turn; click" : "Click"} a pixel to see why it has its colour.`);
  }
  if (changed && (isCompared() ? left.isSame && right.isSame : left.isSame))
    words.push(`${changed} changes no pixel. ${whyNoChange[changed] ?? "Nothing in this picture asks for it."}`);
  say(words.join(" "));
  printed.textContent = left.printed;
  printed.hidden = left.printed === "";
}

const percent = (share) => `${(100 * share).toPrecision(share < 0.01 ? 1 : 2)} %`;

// --- Controls

const bare = (name) => name.replace(/^--/, "");

/** One control for one side. */
function inputOf(control, side) {
  const value = sides[side][control.name] ?? control.preset;
  const label = `${bare(control.name)}${isCompared() ? (side === 0 ? ", left" : ", right") : ""}: ${control.help}`;
  let input;
  if (control.kind === "choice")
    input = element("select", {}, ...control.words.map((word) => element("option", { textContent: word, selected: word === value })));
  else if (control.kind === "flag") input = element("input", { type: "checkbox", checked: value === "true" });
  else if (control.kind === "number")
    input = element("input", { type: "number", value, min: control.least, max: control.most, step: control.isWhole ? 1 : "any" });
  else input = element("input", { type: "text", value });
  input.disabled = control.name in unavailable;
  input.title = unavailable[control.name] ?? control.help;
  input.onchange = () => {
    const chosen = input.type === "checkbox" ? String(input.checked) : input.value;
    setOption(side, control, chosen);
    if (!isCompared()) setOption(1, control, chosen);
    changed(control.name);
  };
  return labelled(input, label);
}

/** What is as in the lesson is not named, unless --quality may say otherwise. */
function setOption(side, control, value) {
  const isUsual = value === control.preset && !("--quality" in sides[side] && control.name !== "--quality");
  if (isUsual || value === "") delete sides[side][control.name];
  else sides[side][control.name] = value;
}

/** The group that an option belongs to: of groups, the index. */
function groupOf({ name }) {
  if (viewOptions.includes(name)) return 1;
  const from = Object.keys(inherited).find((number) => inherited[number].split(" ").includes(bare(name)));
  return from && from < lessonName.slice(0, 2) ? 2 : 0;
}

function buildOptions() {
  groups.forEach((group, i) => {
    const options = lesson.controls.filter((control) => groupOf(control) === i);
    group.hidden = options.length === 0;
    const box = group.lastElementChild;
    box.classList.toggle("compared", isCompared());
    const heads = isCompared() ? [element("div", { className: "option" }, ...["", "left", "right"].map((textContent) => element("span", { textContent })))] : [];
    box.replaceChildren(...heads, ...options.map((control) => {
      const why = unavailable[control.name] ?? (i === 0 ? control.help : "");
      const name = element("span", { className: "name", textContent: bare(control.name), title: control.help });
      return element("div", { className: "option" }, name, ...shownSides().map((side) => inputOf(control, side)), ...(why ? [element("small", { textContent: why })] : []));
    }));
  });
}

function buildCommands() {
  if (isSandbox) return;
  commands.replaceChildren(...shownSides().map((i) => {
    const side = sides[i];
    const isLab = lesson.methods?.some((name) => name in side);
    const words = [`./lessons/run ${own ? "--mine " : isLab ? "lab " : ""}${lessonName.slice(0, 2)}`];
    if (size !== usualSize) words.push(`--size ${size}`);
    if (probed && i === probedSide) words.push(`--probe ${probed.join()}`);
    if (model !== lesson.model) words.push(`--model ${model}`);
    for (const { name, kind } of lesson.controls)
      if (name in side) words.push(kind === "flag" ? name : `${name} ${/^[\w.,-]+$/.test(side[name]) ? side[name] : `'${side[name]}'`}`);
    const text = words.join(" ");
    const copy = labelled(element("button", { type: "button", textContent: "Copy" }), "Copy the command line");
    copy.onclick = async () => {
      await navigator.clipboard.writeText(text);
      copy.textContent = "Copied";
      setTimeout(() => (copy.textContent = "Copy"), 1500);
    };
    return element("div", {}, element("code", { textContent: text }), copy);
  }));
}

function buildAll() {
  modelChoice.value = model;
  sizeChoice.value = size;
  modeChoice.value = mode;
  gainChoice.value = gain;
  gainLabel.hidden = mode !== "difference";
  presetLabel.hidden = !isCompared();
  buildOptions();
  buildCommands();
}

/** After any change of the state: the address, the command line, and the picture. */
function changed(name = "", isMoving = false) {
  if (!own || isSandbox) history.replaceState(null, "", addressOf());
  buildCommands();
  draw(isMoving, name);
}

// --- The address

function addressOf() {
  const pairs = pairsOf(location.hash).filter(([name]) => ofEditor.includes(name));
  if (model !== lesson.model) pairs.push(["model", model]);
  if (size !== usualSize) pairs.push(["size", size]);
  for (const { name, preset } of lesson.controls) {
    const [left, right] = sides.map((side) => side[name] ?? preset);
    if (name in sides[0] || (isCompared() && left !== right)) pairs.push([bare(name), left]);
    if (isCompared() && left !== right) pairs.push(["against", right]);
  }
  if (isCompared() && !pairs.some(([name]) => name === "against")) pairs.push(["compare", "yes"]);
  if (mode === "difference") pairs.push(["difference", gain]);
  if (probed) pairs.push(["probe", probed.join()]);
  return pairs.length > 0 ? `#${pairs.map(([name, value]) => `${name}=${encodeURIComponent(value).replaceAll("%2C", ",")}`).join("&")}` : location.pathname + location.search;
}

/** What stands behind #, as names and values. */
function pairsOf(hash) {
  return hash.includes("=") ? hash.slice(1).split("&").map((pair) => {
    const [name, ...rest] = pair.split("=");
    return [name, decodeURIComponent(rest.join("="))];
  }) : [];
}

/** @throws  Says what of the address is wrong. */
function readAddress() {
  model = lesson.model;
  size = usualSize;
  sides = [{}, {}];
  mode = "picture";
  probed = null;
  let last = null;
  for (const [name, value] of pairsOf(location.hash)) {
    if (ofEditor.includes(name)) continue;
    const control = lesson.controls.find((each) => each.name === `--${name}`);
    if (name === "model" && models.includes(value)) model = value;
    else if (name === "size" && sizes.includes(value)) size = value;
    else if (name === "probe" && lesson.hasProbe && isPixel(value)) probed = value.split(",").map(Number);
    else if (name === "compare") mode = "compare";
    else if (name === "difference" && [1, 2, 4, 8, 16, 32, 64].includes(+value)) [mode, gain] = ["difference", +value];
    else if (name === "against" && last) {
      setOption(1, last, value);
      if (mode === "picture") mode = "compare";
    } else if (control && !(control.name in unavailable)) {
      setOption(0, control, value);
      setOption(1, control, value);
      last = control;
    } else throw new Error(`The address asks for ${name}=${value}, which this page does not have.`);
  }
}

/** @param {string} text  X,Y in a picture of the size that was read before. */
function isPixel(text) {
  const [, x, y] = text.match(/^(\d+),(\d+)$/) ?? [];
  const [width, height] = wholeSize();
  return x !== undefined && +x < width && +y < height;
}

function takeAddress() {
  try {
    readAddress();
    buildAll();
    draw();
  } catch (error) {
    buildAll();
    say(error.message, true);
    place.dataset.state = "failed";
  }
}

// --- Turning by pointer and keys

const canTurn = () => lesson.controls.some(({ name }) => name === "--yaw");

function turn(right, up, nearer = 0) {
  const orbit = (name) => lesson.controls.find((control) => control.name === name);
  if (!canTurn()) return;
  for (const side of [0, 1]) {
    const add = (name, amount, factor = 1) => {
      const control = orbit(name);
      const value = +(sides[side][name] ?? control.preset) * factor + amount;
      const digits = name === "--distance" ? 3 : 1;
      setOption(side, control, String(+Math.min(Math.max(value, control.least), control.most).toFixed(digits)));
    };
    add("--yaw", -right);
    add("--pitch", up);
    if (nearer !== 0) add("--distance", 0, Math.exp(-nearer));
  }
  changed("", true);
}

/** @param {number[]} pixel  Of the whole picture; one outside of it is taken to its border. */
function probe(pixel, side) {
  if (!lesson?.hasProbe) return;
  probed = pixel.map((at, i) => Math.min(Math.max(at, 0), wholeSize()[i] - 1));
  probedSide = side;
  changed();
}

const pointers = new Map();
let pressed = null;  // where a pointer went down, as long as it may be a click
let startX = 0;
let pinch = 0;
canvases.forEach((canvas) => {
  canvas.tabIndex = 0;
  canvas.setAttribute("role", "img");
});
stage.addEventListener("pointerdown", (event) => {
  if (event.target === handle) return;
  pointers.set(event.pointerId, event);
  stage.setPointerCapture(event.pointerId);
  pressed = pointers.size === 1 ? event : null;
  startX = event.clientX;
  pinch = 0;
});
stage.addEventListener("pointermove", (event) => {
  const before = pointers.get(event.pointerId);
  if (!before) return;
  if (pressed && Math.hypot(event.clientX - pressed.clientX, event.clientY - pressed.clientY) < 4) return;
  pressed = null;
  pointers.set(event.pointerId, event);
  if (pointers.size === 2) {
    const [a, b] = [...pointers.values()];
    const apart = Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
    if (pinch > 0 && apart > 0) turn(0, 0, Math.log(apart / pinch));
    pinch = apart;
  } else {
    const degrees = 200 / stage.clientWidth;  // a picture's width
    const scrolls = event.pointerType === "touch" && Math.abs(event.clientX - startX) < 12;  // as far as one can tell
    if (!scrolls) turn((event.clientX - before.clientX) * degrees, (event.clientY - before.clientY) * degrees);
  }
});
for (const end of ["pointerup", "pointercancel"])
  stage.addEventListener(end, (event) => {
    pointers.delete(event.pointerId);
    if (pressed && end === "pointerup") {
      const box = stage.getBoundingClientRect();
      const at = [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
      const side = mode === "compare" && 100 * at[0] > +handle.value ? 1 : 0;
      probe(at.map((share, i) => Math.floor(share * wholeSize()[i])), side);
    }
    pressed = null;
    if (lesson && pointers.size === 0) buildOptions();
  });
stage.addEventListener("wheel", (event) => {
  if (!stage.contains(document.activeElement)) return;  // the page scrolls
  event.preventDefault();
  turn(0, 0, -event.deltaY / 800);
}, { passive: false });
stage.addEventListener("keydown", (event) => {
  const steps = { ArrowLeft: [-5, 0], ArrowRight: [5, 0], ArrowUp: [0, 5], ArrowDown: [0, -5], "+": [0, 0, 0.1], "-": [0, 0, -0.1] };
  const step = event.target !== handle && steps[event.key];
  const middle = wholeSize().map((length) => length >> 1);
  if (event.key === "Enter") probe(probed ?? middle, probedSide);
  else if (event.key === "Escape") unprobe();
  else if (step && event.shiftKey && step.length === 2) probe((probed ?? middle).map((at, i) => at + Math.sign([step[0], -step[1]][i])), probedSide);
  else if (step) turn(...step);
  else return;
  event.preventDefault();
});

function unprobe() {
  probed = null;
  changed();
}

handle.oninput = placeSplit;
close.onclick = unprobe;
stop.onclick = () => startWorker("Stopped.");
modelChoice.onchange = () => {
  model = modelChoice.value;
  changed();
};
sizeChoice.onchange = () => {
  size = sizeChoice.value;
  probed = null;
  changed();
};
modeChoice.onchange = () => {
  mode = modeChoice.value;
  probedSide = 0;
  buildAll();
  changed();
};
gainChoice.onchange = () => {
  gain = +gainChoice.value;
  changed();
};
presets.onchange = () => {
  const view = Object.fromEntries(Object.entries(sides[0]).filter(([name]) => ["--yaw", "--pitch", "--distance", "--fov", "--camera"].includes(name)));
  if (presets.value === "lesson") sides[1] = view;
  if (presets.value === "samples") sides[1] = { ...sides[0], "--samples": "16" };
  presets.value = "";
  buildOptions();
  changed();
};
reset.onclick = () => {
  history.replaceState(null, "", location.pathname + location.search);
  takeAddress();
};
addEventListener("hashchange", () => lesson && takeAddress());

// --- The reader's own program

/** A command line's options, as settings and a model; what only the command line has is passed over. */
function settingsOf(words) {
  const settings = {};
  let model = lesson.model;
  words.forEach((word, i) => {
    const control = lesson.controls.find(({ name }) => name === word);
    if (word === "--model") model = words[i + 1];
    else if (control) settings[word] = control.kind === "flag" ? "true" : words[i + 1];
  });
  return { settings, model };
}

/**
 * From now on a reader's program draws, with its controls and its probe; for null the lesson's.
 *
 * @param {Uint8Array?} program  As docs/live/live_app.cpp exports its functions.
 * @param {string[]?} options    To draw with; else those of before stay, as far as it has them.
 */
place.setProgram = async (program, options = null) => {
  if (!program && !own) return;
  own = program;
  startWorker("Stopped.");
  const isFirst = lesson === null;
  place.dataset.state = "drawing";
  try {
    lesson = await give("lesson", programName());
    if (isFirst) build();
    if (isFirst && pairsOf(location.hash).some(([name]) => !ofEditor.includes(name))) return takeAddress();
    if (options || isFirst) {
      const asked = settingsOf(options ?? []);
      sides = [asked.settings, { ...asked.settings }];
      model = asked.model;
      mode = "picture";
    }
    const names = lesson.controls.map(({ name }) => name);
    sides = sides.map((side) => Object.fromEntries(Object.entries(side).filter(([name]) => names.includes(name))));
    if (!lesson.hasProbe) probed = null;
    if (isSandbox) history.replaceState(null, "", addressOf());
    buildAll();
    draw();
  } catch (error) {
    say(error.message, true);
    place.dataset.state = "failed";
    place.dispatchEvent(new Event("drawn"));
  }
};

/** Another picture by the same program, beside the page's: its pixels, four bytes each. */
place.drawPicture = async (options, size) => {
  const { settings, model } = settingsOf(options);
  await give("lesson", programName());
  await give("scene", model);
  return (await ask("draw", { side: "beside", name: programName(), model, settings, size })).pixels;
};

function isBegun() {
  try {
    return localStorage.getItem(`rasterbook ${lessonName}`) !== null;
  } catch {
    return false;  // nothing is kept here
  }
}

const write = element("button", { type: "button", className: "write", textContent: isBegun() ? "Go on writing" : "Write it yourself" });
const writeNote = element("span");

async function openEditor() {
  write.disabled = true;
  try {
    if (location.protocol === "file:")
      throw new Error(`The editor takes a server: run ./docs/run --serve, and open http://127.0.0.1:8000/${location.pathname.split("/").at(-1)}`);
    const { open } = await import("./editor/editor.js");
    await open(place);
    offer.hidden = true;
  } catch (error) {
    writeNote.textContent = error.message;
  }
  write.disabled = false;
}

const offer = element("p", { className: "offer", hidden: !("editor" in place.dataset) }, write, writeNote);
writeNote.textContent = "in this page: with an editor, the compiler and the tests, and nothing to install";
write.onclick = openEditor;
place.addEventListener("editorclosed", () => {
  offer.hidden = false;
  write.focus();
});

// --- The beginning

function build() {
  place.append(bar, ...groups, commands);
  stage.classList.toggle("turns", canTurn());
  const label = `The lesson's picture, drawn here${canTurn() ? "; the arrow keys turn it, + and - go nearer and farther" : ""}${lesson.hasProbe ? "; Enter says why a pixel has its colour, Shift with arrow keys goes to its neighbours" : ""}`;
  canvases.forEach((canvas) => labelled(canvas, label));
}

async function begin() {
  if (typeof WebAssembly !== "object" || typeof DecompressionStream !== "function") {
    say("This browser has no WebAssembly, or cannot unpack what is compressed: the picture stands still.", true);
    place.dataset.state = "failed";
    offer.hidden = true;
    return;
  }
  if (isSandbox) return openEditor();
  try {
    startWorker();
    lesson = await give("lesson", programName());
    build();
    takeAddress();
  } catch (error) {
    say(error.message, true);
    place.dataset.state = "failed";
  }
}

place.append(stage, element("div", { className: "said" }, status, stop), offer, probeBox, printed);
begin();
