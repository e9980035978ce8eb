// SPDX-License-Identifier: MIT
// What the figures share: their place in the page, the lesson's code as WebAssembly, handles and controls.
const figureModules = {};  // by name: WebAssembly, gzip, base64

// Text of an SVG element.
function shape(tag, attributes, content = "") {
  const list = Object.entries(attributes).map(([name, value]) => ` ${name}="${value}"`);
  return `<${tag}${list.join("")}>${content}</${tag}>`;
}

function polygon(points, kind) {
  return shape("polygon", { points: points.map((p) => p.join()).join(" "), class: kind });
}

function segment([x1, y1], [x2, y2], kind) {
  return shape("line", { x1, y1, x2, y2, class: kind });
}

function arrow([x1, y1], [x2, y2], kind) {
  const x = x2 - x1, y = y2 - y1, length = Math.hypot(x, y) || 1, size = Math.min(10, length / 2);
  const back = [x2 - (x / length) * size, y2 - (y / length) * size];
  const aside = [(y / length) * size * 0.45, (-x / length) * size * 0.45];
  const tip = [[x2, y2], [back[0] + aside[0], back[1] + aside[1]], [back[0] - aside[0], back[1] - aside[1]]];
  return segment([x1, y1], back, `rule ${kind}`) + polygon(tip, `mark ${kind}`);
}

function dot([cx, cy], r, kind) {
  return shape("circle", { cx, cy, r, class: kind });
}

function label([x, y], content, kind = "") {
  return shape("text", { x, y, class: kind }, content);
}

// A number as the texts write it, with a true minus sign and no more digits than it needs.
function number(value, digits = 2) {
  return String(+value.toFixed(digits)).replace("-", "\u2212");
}

function clamp(value, least, most) {
  return Math.min(Math.max(value, least), most);
}

// Bytes of red, green, blue and alpha as a picture that SVG can show.
function pixelsAsImage(code, at, width, height) {
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [width, height];
  const bytes = new Uint8ClampedArray(code.memory.buffer, at, width * height * 4).slice();
  canvas.getContext("2d").putImageData(new ImageData(bytes, width, height), 0, 0);
  return canvas.toDataURL();
}

async function instantiate(name) {
  const packed = Uint8Array.from(atob(figureModules[name]), (letter) => letter.charCodeAt(0));
  const unpacked = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  const missing = { get: (_, called) => () => { throw new Error(`${name} calls ${called}`); } };
  const imports = new Proxy({}, { get: () => new Proxy({}, missing) });
  const { instance } = await WebAssembly.instantiate(await new Response(unpacked).arrayBuffer(), imports);
  instance.exports._initialize();
  return instance.exports;
}

// Puts the live figure of this name into its place; the still picture before it then goes.
//
// describe(code) gives, `code` being what NAME.cpp exports:
//   title, caption
//   layout(width)  { height, to(point), from(pixel) }: the picture's height, and its map from the figure's
//                  own units to pixels and back
//   draw(layout)   the picture as SVG
//   readout()      what stands below the picture, item by item
//   handles        [{ name, at(), move(x, y), text(), step, letter, kind }]: a point that can be dragged, in
//                  the figure's units; text() says where it is
//   controls       [{ label, value, set(value), options: [[value, text], ...] }] or, for a slider,
//                  { label, value, set(value), min, max, step, text(value) }
async function figure(name, describe) {
  const place = document.querySelector(`.figure[data-name="${name}"]`);
  if (!place || !window.WebAssembly || !window.DecompressionStream) return;  // the still picture stays
  const it = describe(await instantiate(name));

  const box = document.createElement("figure");
  box.innerHTML = `<svg role="group" aria-label="${it.title}"><g class="drawing"></g></svg>
<div class="readout"></div><div class="controls"></div><figcaption>${it.caption}</figcaption>`;
  const [svg, readout, controls] = box.children;
  const drawing = svg.firstElementChild;
  const handles = it.handles.map((handle) => addHandle(svg, handle, () => layout, draw));
  for (const control of it.controls) addControl(controls, control, draw);

  let layout;
  function draw() {
    drawing.innerHTML = it.draw(layout);
    readout.innerHTML = it.readout().map((item) => `<span class="item">${item}</span>`).join(" ");
    for (const show of handles) show();
  }
  function fit() {
    const width = svg.clientWidth;
    if (!width || width === layout?.width) return;
    layout = { width, ...it.layout(width) };
    svg.style.height = `${layout.height}px`;
    draw();
  }

  place.append(box);
  fit();
  new ResizeObserver(fit).observe(svg);
  const still = place.previousElementSibling?.querySelector(":scope > img:only-child");
  still?.classList.add("replaced");
  place.classList.add("live");
}

function addHandle(svg, handle, layoutNow, draw) {
  const knob = document.createElementNS("http://www.w3.org/2000/svg", "g");
  const letter = label([0, -14], handle.letter ?? "", "letter");
  knob.innerHTML = dot([0, 0], 22, "reach") + dot([0, 0], 7, "knob") + letter;
  const attributes = { class: `handle ${handle.kind ?? ""}`, tabindex: 0, role: "slider", "aria-label": handle.name };
  for (const [name, value] of Object.entries(attributes)) knob.setAttribute(name, value);
  svg.append(knob);

  function moveTo(point) {
    handle.move(...point);
    svg.classList.add("used");
    draw();
  }
  let offset = null;  // from the pointer to the knob
  const pointer = (event) => {
    const { left, top } = svg.getBoundingClientRect();
    return [event.clientX - left, event.clientY - top];
  };
  knob.addEventListener("pointerdown", (event) => {
    const [x, y] = pointer(event), [atX, atY] = layoutNow().to(handle.at());
    offset = [atX - x, atY - y];
    knob.setPointerCapture(event.pointerId);
    knob.focus({ preventScroll: true });
    event.preventDefault();
  });
  knob.addEventListener("pointermove", (event) => {
    if (!offset) return;
    const [x, y] = pointer(event);
    moveTo(layoutNow().from([x + offset[0], y + offset[1]]));
  });
  // Or a finger would scroll the page.
  knob.addEventListener("touchstart", (event) => event.preventDefault(), { passive: false });
  for (const end of ["pointerup", "pointercancel"]) knob.addEventListener(end, () => (offset = null));
  knob.addEventListener("keydown", (event) => {
    const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (!way) return;
    event.preventDefault();
    const [x, y] = handle.at(), step = handle.step * (event.shiftKey ? 4 : 1);
    moveTo([x + way[0] * step, y + way[1] * step]);
  });

  return () => {
    const [x, y] = handle.at();
    knob.setAttribute("transform", `translate(${layoutNow().to([x, y])})`);
    knob.setAttribute("aria-valuenow", x);
    knob.setAttribute("aria-valuetext", handle.text?.() ?? `${number(x)}, ${number(y)}`);
  };
}

function addControl(controls, control, draw) {
  const change = (value) => {
    control.set(value);
    draw();
  };
  if (control.options) {
    const group = document.createElement("fieldset");
    group.innerHTML = `<legend>${control.label}</legend>`;
    for (const [value, text] of control.options) {
      const option = document.createElement("label");
      option.innerHTML = `<input type="radio" value="${value}"><span>${text}</span>`;
      const radio = option.firstElementChild;
      radio.name = `figure_${control.label}`;
      radio.checked = value === control.value;
      radio.addEventListener("change", () => change(value));
      group.append(option);
    }
    controls.append(group);
    return;
  }
  const row = document.createElement("label");
  const { min, max, step } = control;
  row.innerHTML = `<span>${control.label}</span><input type="range" min="${min}" max="${max}" step="${step}"
value="${control.value}"><output>${control.text(control.value)}</output>`;
  const [, slider, output] = row.children;
  slider.addEventListener("input", () => {
    change(slider.valueAsNumber);
    output.textContent = control.text(slider.valueAsNumber);
  });
  controls.append(row);
}
