// SPDX-License-Identifier: MIT
figure("footprint", (code) => {
  const columns = 40, rows = 30, texels = 64, pixel = [25, 11];
  let pitch = (28 * Math.PI) / 180, filter = "0", floor = "";

  const levels = [];
  for (let level = 0; level < 7; ++level) {
    const side = texels >> level;
    levels.push(pixelsAsImage(code, code.texels_of(level), side, side));
  }
  const render = () => (floor = pixelsAsImage(code, code.draw(pitch, +filter), columns, rows));
  render();

  function seen() {
    const numbers = new Float32Array(code.memory.buffer, code.seen_in(...pixel), 8);
    const [isFloor, x, y, acrossX, acrossY, downX, downY, level] = numbers;
    return { isFloor, at: [x, y], across: [acrossX, acrossY], down: [downX, downY], level };
  }
  // The nearest pixel from there on downwards that shows the floor.
  function choose(x, y) {
    pixel[0] = clamp(Math.floor(x), 0, columns - 1);
    pixel[1] = clamp(Math.floor(y), 0, rows - 1);
    while (!seen().isFloor && pixel[1] < rows - 1) ++pixel[1];
  }

  const image = (href, x, y, width, height) =>
    shape("image", { href, x, y, width, height, preserveAspectRatio: "none", style: "image-rendering: pixelated" });

  // The texture with the middle of the footprint in the middle, at the finer of the two levels that are read.
  function drawTexture({ left, top, side }) {
    const { at, across, down, level } = seen(), scale = side / texels;
    const finer = levels[Math.floor(Math.min(level, 6))];
    const parts = [], [x, y] = at.map((coordinate) => side / 2 - coordinate * scale);
    for (let i = -1; i <= 1; ++i)
      for (let j = -1; j <= 1; ++j)
        parts.push(image(finer, x + i * side, y + j * side, side + 0.5, side + 0.5));
    const corner = (i, j) => [0, 1].map((axis) => side / 2 + scale * (i * across[axis] + j * down[axis]));
    const [a, b, c, d] = [corner(-0.5, -0.5), corner(0.5, -0.5), corner(0.5, 0.5), corner(-0.5, 0.5)];
    parts.push(polygon([a, b, c, d], "footprint"), arrow(d, c, "four"), arrow(a, d, "ink"));
    return shape("svg", { x: left, y: top, width: side, height: side }, parts.join(""));
  }

  return {
    title: "A pixel of a floor in perspective, and its footprint on the texture",
    caption: `Drag the pixel over the floor. The right square shows 64 × 64 texels of the texture around its centre, in the finer of the two levels that trilinear filtering reads; the outlined area is the pixel's footprint. Far away it grows, mostly away from the viewer.`,
    layout: (width) => {
      const wide = width > 500, screenWidth = wide ? width * 0.56 : width;
      const screenHeight = (screenWidth * rows) / columns;
      const side = wide ? screenHeight : Math.min(width, 280), cell = screenWidth / columns;
      return {
        screenWidth, screenHeight, side, cell,
        left: wide ? width - side : (width - side) / 2,
        top: wide ? 0 : screenHeight + 16,
        height: wide ? screenHeight : screenHeight + 16 + side,
        to: ([x, y]) => [x * cell, y * cell],
        from: ([x, y]) => [x / cell, y / cell],
      };
    },
    draw: (layout) => {
      const { screenWidth: width, screenHeight: height, cell, left, top, side, to } = layout, [x, y] = to(pixel);
      return [
        shape("rect", { width, height, class: "area sky" }),
        image(floor, 0, 0, width, height),
        shape("rect", { x, y, width: cell, height: cell, class: "rule four" }),
        drawTexture(layout),
        shape("rect", { x: left, y: top, width: side, height: side, class: "grid" }),
      ].join("");
    },
    readout: () => {
      const { across, down, level } = seen(), lengths = [across, down].map((side) => Math.hypot(...side));
      const vector = ([x, y]) => `(${number(x, 1)}, ${number(y, 1)})`;
      return [
        `<b class="four">e<sub>x</sub></b> = ${vector(across)}`,
        `<b>e<sub>y</sub></b> = ${vector(down)} texels`,
        `ϱ = ${number(Math.max(...lengths), 2)}`,
        `level = <b>${number(level)}</b>`,
      ];
    },
    handles: [
      {
        name: "Pixel",
        kind: "small",
        step: 1,
        at: () => [pixel[0] + 0.5, pixel[1] + 0.5],
        text: () => `pixel ${pixel.join(", ")}, level ${number(seen().level)}`,
        move: choose,
      },
    ],
    controls: [
      {
        label: "Camera", min: 18, max: 60, step: 1, value: 28, text: (n) => `${n}° down`,
        set: (value) => {
          pitch = (value * Math.PI) / 180;
          render();
          choose(...pixel);
        },
      },
      {
        label: "Filter",
        value: filter,
        options: [["0", "nearest"], ["1", "bilinear"], ["2", "trilinear"]],
        set: (value) => {
          filter = value;
          render();
        },
      },
    ],
  };
});
