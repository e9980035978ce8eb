// SPDX-License-Identifier: MIT
figure("line_methods", (code) => {
  const columns = 16, rows = 7, a = [0, 0], b = [14, 5];
  const methods = ["Bresenham", "DDA, float", "DDA, fixed point", "Wu"];
  const kinds = ["one", "two", "three", "ink"];
  let cell = 1, shown = "all", chosen = 7;

  const coverage = (method) => {
    const at = code.coverage_of(method, ...a, ...b, columns, rows);
    return new Float32Array(code.memory.buffer, at, columns * rows).slice();
  };
  const stepOf = (k) => {
    const numbers = new Float64Array(code.memory.buffer, code.step_of(...a, ...b, k), 10);
    const [rise, row, error, floatRow, fixedRow, start, length, minor, steep, direction] = numbers;
    return { rise, row, error, floatRow, fixedRow, start, length, minor, steep, direction };
  };
  const pixelOf = ({ start, row, steep, direction }, k) => {
    const first = steep ? (a[1] < b[1] ? a[0] : b[0]) : a[0] <= b[0] ? a[1] : b[1];
    return steep ? [first + direction * row, start + k] : [start + k, first + direction * row];
  };

  const end = (name, point) => ({
    name: `End ${name}`,
    letter: name,
    step: 1,
    at: () => point,
    move: (x, y) => {
      point[0] = clamp(Math.round(x), 0, columns - 1);
      point[1] = clamp(Math.round(y), 0, rows - 1);
      chosen = Math.min(chosen, stepOf(0).length);
    },
  });

  // Of all methods, each has a third of the pixel; Wu's coverage lies behind them.
  function drawPixels({ corner }) {
    const parts = [];
    [3, 0, 1, 2].forEach((method) => {
      if (shown !== "all" && +shown !== method) return;
      const third = shown === "all" && method < 3 ? cell / 3 : 0;
      coverage(method).forEach((share, i) => {
        if (share === 0) return;
        const [x, y] = corner([i % columns, Math.floor(i / columns)]);
        const opacity = method < 3 ? 0.75 : share * (shown === "all" ? 0.3 : 0.8);
        const box = { x, y: y + method * third, width: cell, height: third || cell };
        parts.push(shape("rect", { ...box, class: `mark ${kinds[method]}`, "fill-opacity": opacity }));
      });
    });
    return parts.join("");
  }

  // The decision variable after each step, between half a row up and half a row down.
  function drawErrors({ corner, plot, width }) {
    const { start, length, steep } = stepOf(0);
    const middle = plot + 54, unit = 40 / Math.max(length, 1);
    const across = (y, kind) => segment([0, y], [width, y], kind);
    const parts = [across(middle, "rule ink"), across(middle - 40, "grid"), across(middle + 40, "grid")];
    parts.push(label([width, middle - 6], "e", "end"));
    for (let k = 0; k <= length; ++k) {
      const { error } = stepOf(k), [x] = corner([(steep ? 0 : start) + k, 0]), size = Math.abs(error) * unit;
      const bar = { x: x + cell * 0.2, y: middle - (error > 0 ? 0 : size), width: cell * 0.6, height: size, rx: 2 };
      const look = k === chosen ? { class: "mark four" } : { class: "mark", "fill-opacity": 0.55 };
      parts.push(shape("rect", { ...bar, ...look }));
      const place = [x + cell / 2, middle + (error > 0 ? -5 : 14)];
      if (cell > 30 && error !== 0) parts.push(label(place, number(error), "middle small"));
    }
    return parts.join("");
  }

  return {
    title: "A line over enlarged pixels, by four methods",
    caption: `Drag the ends, or the step. In step 7 of the first line, the exact row is 2.5, a tie; both DDAs have rounded the slope and choose the row below. The bars show Bresenham's decision variable e after each step: it stays between the thin lines at −Δx and Δx.`,
    layout: (width) => {
      cell = width / columns;
      return {
        plot: rows * cell,
        height: rows * cell + 100,
        corner: ([x, y]) => [x * cell, y * cell],
        to: ([x, y]) => [(x + 0.5) * cell, (y + 0.5) * cell],
        from: ([x, y]) => [x / cell - 0.5, y / cell - 0.5],
      };
    },
    draw: (layout) => {
      const { corner, to } = layout, parts = [drawPixels(layout)];
      for (let x = 0; x <= columns; ++x) parts.push(segment(corner([x, 0]), corner([x, rows]), "grid"));
      for (let y = 0; y <= rows; ++y) parts.push(segment(corner([0, y]), corner([columns, y]), "grid"));
      const [x, y] = corner(pixelOf(stepOf(chosen), chosen));
      parts.push(shape("rect", { x, y, width: cell, height: cell, class: "rule four" }));
      parts.push(segment(to(a), to(b), "rule ink"), drawErrors(layout));
      return parts.join("");
    },
    readout: () => {
      const { rise, row, error, floatRow, fixedRow, length, minor } = stepOf(chosen);
      const before = chosen > 0 ? stepOf(chosen - 1).error + 2 * minor : 0;
      return [
        `k = ${chosen}`,
        `r = ${number(rise, 4)}`,
        `e = ${number(before)} ${before > length ? ">" : "≤"} Δx = ${length}`,
        `so j = <b class="one">${row}</b>, e = ${number(error)}`,
        `<span class="two">float y = ${+floatRow.toPrecision(8)}</span>`,
        `<span class="three">fixed-point y = ${+fixedRow.toPrecision(8)}</span>`,
      ];
    },
    handles: [
      end("a", a), end("b", b),
      {
        name: "Step k",
        kind: "small",
        step: 1,
        at: () => pixelOf(stepOf(chosen), chosen),
        text: () => `step ${chosen}`,
        move: (x, y) => {
          const { start, length, steep } = stepOf(0);
          chosen = clamp(Math.round(steep ? y : x) - start, 0, length);
        },
      },
    ],
    controls: [
      {
        label: "Method",
        value: shown,
        options: [
          ["all", "All at once"],
          ...methods.map((name, i) => [String(i), `<i class="key ${kinds[i]}"></i>${name}`]),
        ],
        set: (value) => (shown = value),
      },
    ],
  };
});
