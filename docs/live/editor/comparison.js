// SPDX-License-Identifier: MIT
// Where a picture is not as expected: the two beside each other, and where they differ.

import { element } from "./elements.js";

/** @return {ImageData}  Of a picture in the site's folder. */
export async function readPicture(url) {
  const answer = await fetch(url);
  if (!answer.ok) throw new Error(`${url} cannot be read.`);
  // Nothing is to change the bytes on their way.
  const bitmap = await createImageBitmap(await answer.blob(), { colorSpaceConversion: "none", premultiplyAlpha: "none" });
  const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
  const context = canvas.getContext("2d");
  context.drawImage(bitmap, 0, 0);
  return context.getImageData(0, 0, bitmap.width, bitmap.height);
}

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
