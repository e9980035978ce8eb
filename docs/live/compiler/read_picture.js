// SPDX-License-Identifier: MIT

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
