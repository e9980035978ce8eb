// SPDX-License-Identifier: MIT
// Where a picture is not as expected: the two beside each other, and where they differ.

import { element } from "./elements.js";

function canvasOf(pixels, label) {
  const canvas = element("canvas", { width: pixels.width, height: pixels.height, role: "img", "aria-label": label });
  canvas.getContext("2d").putImageData(pixels, 0, 0);
  return canvas;
}

/** @return {Element[]}  The figures, and how many pixels differ. */
export function comparisonOf(expected, own) {
  const { width, height } = expected;
  const difference = new ImageData(width, height);
  let count = 0;
  for (let i = 0; i < difference.data.length; i += 4) {
    let most = 0;
    for (let c = i; c < i + 3; ++c) {
      const apart = Math.abs(expected.data[c] - own.data[c]);
      difference.data[c] = Math.min(255, 8 * apart);
      most = Math.max(most, apart);
    }
    difference.data[i + 3] = 255;
    if (most > 0) ++count;
  }
  const share = (100 * count) / (width * height);
  const figures = [["Expected", expected], ["Yours", own], ["Difference, times 8", difference]].map(([name, pixels]) =>
    element("figure", {}, canvasOf(pixels, name), element("figcaption", { textContent: name })));
  const words = `${count.toLocaleString("en")} of ${(width * height).toLocaleString("en")} pixels differ${count > 0 ? ` (${share.toPrecision(2)} %)` : ""}.`;
  return [element("div", { className: "compared-pictures" }, ...figures), element("p", { textContent: words })];
}
