// SPDX-License-Identifier: MIT

/** A file of gzip, unless the server has told the browser to unpack it. */
export async function unpacked(blob) {
  const [first, second] = new Uint8Array(await blob.slice(0, 2).arrayBuffer());
  const isPacked = first === 0x1f && second === 0x8b;
  return new Response(isPacked ? blob.stream().pipeThrough(new DecompressionStream("gzip")) : blob.stream());
}
