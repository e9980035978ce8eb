// SPDX-License-Identifier: MIT
figure("clipping", (code) => {
  const vertices = [[-1.2, -5.2], [2.9, -3.4], [0.3, 0.6]];
  const names = ["a", "b", "c"];
  const planeNames = ["left", "right", "bottom", "top", "near", "far"];
  let near = 1, half = (28 * Math.PI) / 180, fan = [], outside = [];

  function update() {
    const count = code.clip(half, near, ...vertices.flat());
    const numbers = new Float32Array(code.memory.buffer, code.clipped(), count * 12);
    const vertex = (i) => {
      const [viewX, viewZ, ndcX, ndcZ] = numbers.subarray(4 * i, 4 * i + 4);
      return { view: [viewX, viewZ], ndc: [ndcX, ndcZ] };
    };
    fan = Array.from({ length: count }, (_, i) => [0, 1, 2].map((k) => vertex(3 * i + k)));
    const distances = new Float32Array(code.memory.buffer, code.plane_distances(), 18);
    outside = names.map((_, i) => planeNames.filter((__, plane) => distances[6 * i + plane] < 0));
  }
  // The fan's outline: its first triangle, and one vertex of each that follows.
  const outline = () => (fan.length ? [...fan[0], ...fan.slice(1).map((triangle) => triangle[2])] : []);

  function drawPolygon(kind, to) {
    const points = outline().map((vertex) => to(vertex[kind]));
    const cut = ([first, second]) => segment(to(first[kind]), to(second[kind]), "rule one thin");
    return [
      polygon(points, "area one"),
      ...fan.slice(1).map(cut),
      polygon(points, "rule one"),
      ...points.map((point) => dot(point, 4, "mark one")),
    ].join("");
  }

  return {
    title: "A triangle seen from above, clipped to the frustum",
    caption: `Drag the vertices or the near plane. On one side, view space from above: clipping leaves the filled polygon, and the thin lines cut it into a fan of triangles. On the other side, the same polygon in NDC: if the near plane is close to the eye, most depths are close to 0.`,
    layout: (width) => {
      const wide = width > 500, unit = (wide ? width * 0.6 : width) / 8.4;
      const height = 7.7 * unit, eye = [4.2 * unit, 6.5 * unit];
      const side = wide ? width * 0.34 : Math.min(width * 0.62, 230);
      return {
        unit, side,
        left: wide ? width - side - 4 : (width - side) / 2,
        top: wide ? 1.2 * unit : height + 30,
        height: wide ? height : height + side + 50,
        to: ([x, z]) => [eye[0] + x * unit, eye[1] + z * unit],
        from: ([x, y]) => [(x - eye[0]) / unit, (y - eye[1]) / unit],
      };
    },
    draw: ({ to, left, top, side }) => {
      update();
      const across = Math.tan(half), at = (distance, sign) => to([sign * across * distance, -distance]);
      const ndc = ([x, z]) => [left + ((x + 1) / 2) * side, top + z * side];
      return [
        segment(to([0, 0]), at(6.5, -1), "rule ink dashed"), segment(to([0, 0]), at(6.5, 1), "rule ink dashed"),
        polygon([at(near, -1), at(near, 1), at(6.5, 1), at(6.5, -1)], "frustum"),
        dot(to([0, 0]), 5, "mark"),
        polygon(vertices.map(to), "rule four"),
        drawPolygon("view", to),
        shape("rect", { x: left, y: top, width: side, height: side, class: "frustum" }),
        drawPolygon("ndc", ndc),
        label([left + side / 2, top + side + 18], "NDC: near below, far above", "middle small"),
        label([to([0, 0])[0] - 10, to([0, 0])[1] + 5], "eye", "small end"),
      ].join("");
    },
    readout: () => [
      `<b class="one">${outline().length} vertices, ${fan.length} triangles</b>`,
      ...outside.map((list, i) => `${names[i]}: ${list.length ? `outside ${list.join(", ")}` : "inside"}`),
    ],
    handles: [
      {
        name: "Distance of the near plane",
        letter: "near",
        step: 0.1,
        at: () => [0, -near],
        text: () => `${number(near)} in front of the eye`,
        move: (_, z) => (near = clamp(-z, 0.1, 6.2)),
      },
      ...vertices.map((vertex, i) => ({
        name: `Vertex ${names[i]}`,
        letter: names[i],
        step: 0.1,
        at: () => vertex,
        move: (x, z) => {
          vertex[0] = clamp(x, -4.1, 4.1);
          vertex[1] = clamp(z, -6.4, 1.1);
        },
      })),
    ],
    controls: [
      {
        label: "Field of view", min: 20, max: 64, step: 1, value: 56, text: (n) => `${n}°`,
        set: (degrees) => (half = (degrees * Math.PI) / 360),
      },
    ],
  };
});
