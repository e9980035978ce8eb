// SPDX-License-Identifier: MIT
figure("tangent_basis", (code) => {
  const foot = [0.44, 0.12], map = [0, 0], length = 0.55;
  let turn = (20 * Math.PI) / 180, skew = 0.4, mirror = "1";
  let disc = { left: 0, top: 0, side: 1 }, from = (point) => point;

  const pairs = (at, count) => {
    const numbers = new Float32Array(code.memory.buffer, at, 2 * count);
    return Array.from({ length: count }, (_, i) => [numbers[2 * i], numbers[2 * i + 1]]);
  };
  function basis() {
    const at = code.basis_at(...foot, ...map, length);
    const [point, faceTangent, faceBitangent, tangent, bitangent, normal, perturbed] = pairs(at, 7);
    const [faceAngle, angle, handedness] = new Float32Array(code.memory.buffer, at + 56, 3);
    return { point, faceTangent, faceBitangent, tangent, bitangent, normal, perturbed, faceAngle, angle, handedness };
  }
  function lines() {
    const count = code.lay_out(turn, skew, +mirror);
    const numbers = new Float32Array(code.memory.buffer, code.lines_shown(), 5 * count);
    return Array.from({ length: count }, (_, i) => [...numbers.subarray(5 * i, 5 * i + 5)]);
  }
  let textureLines = lines();
  const texels = pixelsAsImage(code, code.disc(), 64, 64);
  const outline = pairs(code.outline(), 56);

  const inDisc = ([x, y]) => [disc.left + ((x + 1) / 2) * disc.side, disc.top + ((1 - y) / 2) * disc.side];
  const named = (point, text, kind, dx, dy) => label([point[0] + dx, point[1] + dy], text, `name ${kind}`);

  return {
    title: "A tangent basis on a hill, and a texel of a normal map",
    caption: `Drag the point over the hill, and the texel in the disc, which holds all normals that a map can store. The thin lines are the texture's: u is constant along the blue ones, v along the green ones. Where the texture is skewed, T and B (dashed) are not perpendicular; T′ and B′ are.`,
    layout: (width) => {
      const wide = width > 500, hill = wide ? width * 0.74 : width, unit = hill / 2.9;
      const side = wide ? width * 0.22 : 130;
      const height = 2.35 * unit, middle = [hill / 2, 1.2 * unit];
      disc = { side, left: width - side - 4, top: wide ? height - side - 24 : height };
      from = ([x, y]) => [(x - middle[0]) / unit, (y - middle[1]) / unit];
      return {
        height: wide ? height : height + side + 24,
        to: ([x, y]) => [middle[0] + x * unit, middle[1] + y * unit],
        from,
      };
    },
    draw: ({ to }) => {
      const paths = ["", ""];
      for (const [ax, ay, bx, by, axis] of textureLines) paths[axis] += `M${to([ax, ay])}L${to([bx, by])}`;
      const it = basis(), point = to(it.point), at = inDisc(map), { left, top, side } = disc;
      const T = to(it.tangent), B = to(it.bitangent), N = to(it.normal), bent = to(it.perturbed);
      return [
        polygon(outline.map(to), "hill"),
        shape("path", { d: paths[0], class: "texture one" }), shape("path", { d: paths[1], class: "texture three" }),
        segment(point, to(it.faceTangent), "rule four dashed"),
        segment(point, to(it.faceBitangent), "rule three dashed"),
        arrow(point, T, "four"), arrow(point, B, "three"), arrow(point, N, "one"),
        map[0] || map[1] ? arrow(point, bent, "two") + named(bent, "N′", "two", 8, -4) : "",
        named(T, "T′", "four", 6, 14), named(B, "B′", "three", -18, 0), named(N, "N", "one", -18, -2),
        shape("image", { href: texels, x: left, y: top, width: side, height: side, class: "disc" }),
        segment([left + side / 2, top], [left + side / 2, top + side], "cross"),
        segment([left, top + side / 2], [left + side, top + side / 2], "cross"),
        segment([left + side / 2, top + side / 2], at, "rule ink"),
        label([left + side / 2, top + side + 16], "texel of the map", "middle small"),
      ].join("");
    },
    readout: () => {
      const { faceAngle, angle, handedness } = basis(), z = Math.sqrt(Math.max(0, 1 - map[0] ** 2 - map[1] ** 2));
      return [
        `h = ${number(handedness)}`,
        `T to B: ${number(faceAngle, 0)}°`,
        `T′ to B′: <b>${number(angle, 0)}°</b>`,
        `<span class="two">texel (${[...map, z].map((component) => number(component)).join(", ")})</span>`,
      ];
    },
    handles: [
      {
        name: "Point on the hill",
        step: 0.05,
        at: () => basis().point,
        text: () => foot.map((coordinate) => number(coordinate)).join(", "),
        move: (x, y) => ([[foot[0], foot[1]]] = pairs(code.nearest(x, y), 1)),
      },
      {
        name: "Normal in the map",
        kind: "small",
        step: 0.04,
        at: () => from(inDisc(map)),
        text: () => `x ${number(map[0])}, y ${number(map[1])}`,
        move: (x, y) => {
          const [discX, discY] = from(inDisc([0, 0])), [right] = from(inDisc([1, 0]));
          const moved = [(x - discX) / (right - discX), (discY - y) / (right - discX)];
          const beyond = Math.max(Math.hypot(...moved) / 0.95, 1);
          [map[0], map[1]] = moved.map((coordinate) => coordinate / beyond);
        },
      },
    ],
    controls: [
      {
        label: "Turn uv", min: -180, max: 180, step: 1, value: 20, text: (n) => `${number(n)}°`,
        set: (degrees) => {
          turn = (degrees * Math.PI) / 180;
          textureLines = lines();
        },
      },
      {
        label: "Skew", min: -1, max: 1, step: 0.05, value: skew, text: (n) => number(n),
        set: (value) => {
          skew = value;
          textureLines = lines();
        },
      },
      {
        label: "Texture",
        value: mirror,
        options: [["1", "as it is"], ["-1", "mirrored"]],
        set: (value) => {
          mirror = value;
          textureLines = lines();
        },
      },
    ],
  };
});
