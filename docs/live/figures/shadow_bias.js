// SPDX-License-Identifier: MIT
figure("shadow_bias", (code) => {
  let elevation = (38 * Math.PI) / 180, size = 24, bias = "2", factor = 0;
  const arm = 3.5;  // from the floor's middle to the light's handle

  const floats = (at, count, each) => {
    const numbers = new Float32Array(code.memory.buffer, at, count * each);
    return Array.from({ length: count }, (_, i) => [...numbers.subarray(i * each, (i + 1) * each)]);
  };
  let texels = [], tested = [];
  function update() {
    code.draw(elevation, size, +bias, factor);
    texels = floats(code.texels(), code.texel_count(), 8);
    tested = floats(code.tested(), code.tested_count(), 4);
  }

  // Neighbours with the same answer as one line.
  function drawSurfaces(to) {
    const lines = [];
    for (const [x, y, face, visibility] of tested) {
      const line = lines[lines.length - 1];
      if (line?.face === face) line.points.push([x, y]);
      if (line?.face !== face || line.visibility !== visibility)
        lines.push({ face, visibility, points: [[x, y]] });
    }
    const kinds = { 1: "surface lit", 0: "surface dark", "-1": "surface away" };
    const draw = ({ points, visibility }) =>
      segment(to(points[0]), to(points[points.length - 1]), kinds[visibility]);
    return lines.map(draw).join("");
  }

  return {
    title: "A crate on a floor, a directional light and its shadow map, cut along the light's rays",
    caption: `Drag the light. Each beam is a texel of the shadow map and holds one depth: the green steps. Surface points are tested against them (amber: lit; dark: in shadow). Without a bias there is acne; a bias of 1 removes it, and a larger one detaches the shadow from the crate.`,
    layout: (width) => {
      const unit = width / 8, floor = 4 * unit;
      return {
        height: floor + 14,
        to: ([x, y]) => [width / 2 + x * unit, floor - y * unit],
        from: ([x, y]) => [(x - width / 2) / unit, (floor - y) / unit],
      };
    },
    draw: ({ to }) => {
      update();
      const parts = texels.map(([ax, ay, bx, by, cx, cy, dx, dy]) =>
        polygon([[ax, ay], [bx, by], [dx, dy], [cx, cy]].map(to), "beam"));
      parts.push(polygon([[-0.7, 0], [-0.7, 1.4], [0.7, 1.4], [0.7, 0]].map(to), "body"), drawSurfaces(to));
      parts.push(...texels.map(([, , , , cx, cy, dx, dy]) => segment(to([cx, cy]), to([dx, dy]), "rule three")));
      const [x, y] = [Math.cos(elevation), Math.sin(elevation)];
      parts.push(arrow(to([arm * x, arm * y]), to([(arm - 0.8) * x, (arm - 0.8) * y]), "ink"));
      return parts.join("");
    },
    readout: () => {
      const facing = tested.filter(([, , face, visibility]) => face === 0 && visibility >= 0);
      const lit = facing.filter(([, , , visibility]) => visibility > 0).length / facing.length;
      const fitted = bias === "4" ? code.offset_of_floor() : code.bias_of_floor();
      const times = `${number(fitted, 4)} × ${number(factor, 1)} = ${number(fitted * factor, 4)}`;
      return [
        `light ${number((elevation * 180) / Math.PI, 0)}° above the floor`,
        fitted >= 2 ? "seen edge-on: called lit" : `${bias === "4" ? "offset" : "bias"} of the floor: ${times}`,
        `lit floor: ${number(100 * lit, 0)} %`,
      ];
    },
    handles: [
      {
        name: "Light's direction",
        step: 0.15,
        at: () => [arm * Math.cos(elevation), arm * Math.sin(elevation)],
        text: () => `${number((elevation * 180) / Math.PI, 0)} degrees above the floor`,
        move: (x, y) => (elevation = clamp(Math.atan2(Math.max(y, 0), x), 0.2, Math.PI - 0.2)),
      },
    ],
    controls: [
      {
        label: "Texels", min: 16, max: 96, step: 1, value: size, text: (n) => `${n} × ${n}`,
        set: (value) => (size = value),
      },
      {
        label: "Bias", min: 0, max: 6, step: 0.1, value: factor, text: (n) => `× ${number(n, 1)}`,
        set: (value) => (factor = value),
      },
      {
        label: "Kind",
        value: bias,
        options: [["1", "constant"], ["2", "slope-scaled"], ["3", "receiver-plane"], ["4", "normal-offset"]],
        set: (value) => (bias = value),
      },
    ],
  };
});
