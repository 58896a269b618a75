"use strict";
// What the pages with data have in common.

const $ = (id) => document.getElementById(id);

/** What Python packed: deflated, in letters. */
async function unpacked(text) {
  const packed = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate")));
}

/** The page's data, once its fonts are there, if it has its own. */
async function received() {
  const data = await (await unpacked($("data").textContent)).json();
  const fonts = Object.entries(data.fonts ?? {}).map(async ([weight, packed]) =>
    new FontFace("Sandbox Sans", await (await unpacked(packed)).arrayBuffer(), { weight }).load());
  for (const font of await Promise.all(fonts)) document.fonts.add(font);
  return data;
}
