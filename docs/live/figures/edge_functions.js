// SPDX-License-Identifier: MIT
figure("edge_functions", (code) => {
  const rows = 6;
  const a = [1, 1], b = [1, 5], c = [5, 1], d = [5, 5], p = [2.5, 2.5];
  let columns = 10, cell = 1, shown = "coverage";
  const names = ["bc", "ca", "ab"].map((edge) => `E<sub>${edge}</sub>`);
  const sides = [[b, c], [c, a], [a, b]];

  const covered = (u, v, w) => {
    const at = code.covered(...u, ...v, ...w, columns, rows);
    return new Uint8Array(code.memory.buffer, at, columns * rows).slice();
  };
  const edgesAt = (x, y) => {
    const at = code.edges_at(...a, ...b, ...c, x, y);
    const [...numbers] = new Float64Array(code.memory.buffer, at, 6);
    return [0, 2, 4].map((i) => {
      const [value, least] = numbers.slice(i, i + 2);
      return { value, owns: least === 0, inside: value >= least };
    });
  };

  const pixel = ([x, y], kind) => shape("rect", { x, y, width: cell, height: cell, class: kind });

  const corner = (name, point) => ({
    name: `Vertex ${name}`,
    letter: name,
    step: 0.5,
    at: () => point,
    move: (x, y) => {
      point[0] = clamp(Math.round(x * 2) / 2, 0, columns);
      point[1] = clamp(Math.round(y * 2) / 2, 0, rows);
    },
  });

  function drawPixels({ to }) {
    const own = covered(a, b, c), next = covered(d, c, b);
    const side = ["bc", "ca", "ab"].indexOf(shown);
    const parts = [], centers = [];
    for (let y = 0; y < rows; ++y)
      for (let x = 0; x < columns; ++x) {
        const edges = edgesAt(x, y), i = y * columns + x, center = to([x + 0.5, y + 0.5]);
        const square = (kind) => parts.push(pixel(to([x, y]), `area ${kind}`));
        if (side < 0 ? own[i] : edges[side].inside) square("one");
        if (side < 0 && next[i]) square("two");
        const value = side < 0 ? "" : number(edges[side].value);
        if (side >= 0) centers.push(label([center[0], center[1] + 5], value, "middle"));
        else centers.push(dot(center, 2.5, "mark"));
      }
    return [parts.join(""), centers.join("")];
  }

  function drawGrid({ to }) {
    const parts = [];
    for (let x = 0; x <= columns; ++x) parts.push(segment(to([x, 0]), to([x, rows]), "grid"));
    for (let y = 0; y <= rows; ++y) parts.push(segment(to([0, y]), to([columns, y]), "grid"));
    return parts.join("");
  }

  return {
    title: "Two triangles that share an edge, over enlarged pixels",
    caption: `Drag the vertices. A pixel is filled if its centre is inside. While the triangles lie on different sides of the red edge, a centre on this edge is filled once. The other buttons show the value of one edge function at every centre; the filled pixels pass its test.`,
    layout: (width) => {
      columns = width < 500 ? 7 : 10;
      cell = width / columns;
      for (const point of [a, b, c, d, p]) point[0] = Math.min(point[0], columns - (point === p ? 0.5 : 0));
      return { height: rows * cell, to: ([x, y]) => [x * cell, y * cell], from: ([x, y]) => [x / cell, y / cell] };
    },
    draw: (layout) => {
      const { to } = layout, side = ["bc", "ca", "ab"].indexOf(shown);
      const [pixels, centers] = drawPixels(layout);
      const parts = [pixels, drawGrid(layout)];
      parts.push(polygon([d, c, b].map(to), "rule two"), polygon([a, b, c].map(to), "rule one"));
      parts.push(segment(...sides[Math.max(side, 0)].map(to), "rule four"), centers);
      parts.push(pixel(to([p[0] - 0.5, p[1] - 0.5]), "rule ink"));
      return parts.join("");
    },
    readout: () => {
      const items = edgesAt(p[0] - 0.5, p[1] - 0.5).map(({ value, owns, inside }, i) => {
        const onEdge = owns ? " (owned)" : " (not owned)";
        return `${names[i]} = <b class="${inside ? "one" : "four"}">${number(value)}</b>${value === 0 ? onEdge : ""}`;
      });
      const twice = code.twice_area(...a, ...b, ...c);
      return [`p = (${number(p[0])}, ${number(p[1])})`, ...items, `2A = ${number(twice)}`];
    },
    handles: [
      corner("a", a), corner("b", b), corner("c", c), corner("d", d),
      {
        name: "Pixel centre p",
        letter: "p",
        kind: "small",
        step: 1,
        at: () => p,
        move: (x, y) => {
          p[0] = clamp(Math.floor(x), 0, columns - 1) + 0.5;
          p[1] = clamp(Math.floor(y), 0, rows - 1) + 0.5;
        },
      },
    ],
    controls: [
      {
        label: "Show",
        value: shown,
        options: [["coverage", "Coverage"], ["bc", names[0]], ["ca", names[1]], ["ab", names[2]]],
        set: (value) => (shown = value),
      },
    ],
  };
});
