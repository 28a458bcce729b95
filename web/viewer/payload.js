// SPDX-License-Identifier: MIT
// The data of the page: base64 pieces -> zlib -> tables of whole numbers (docs/exports.md).

const bytesOf = (text) => {
  const letters = atob(text);
  const bytes = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; ++i) bytes[i] = letters.charCodeAt(i);
  return bytes;
};

/** Resolves when the browser has read the whole page; `onPart` hears the share of pieces that came. */
export async function pageLoaded(pieces, onPart) {
  while (!document.querySelector('[data-part="end"]')) {
    onPart(document.querySelectorAll("[data-part]").length / pieces);
    await new Promise((resolve) => setTimeout(resolve, 30));
  }
}

/** Bytes of one kind of piece, each piece taken out of the page. */
function* takePieces(kind) {
  for (const element of document.querySelectorAll(`[data-part="${kind}"]`)) {
    yield bytesOf(element.textContent);
    element.remove();
  }
}

export const blobOf = (kind, type) => new Blob([...takePieces(kind)], { type });

/** Inflates the tables; `onPart` hears the share that is done. */
export async function inflate(byteCount, onPart) {
  const bytes = new Uint8Array(byteCount);
  const reader = blobOf("tables").stream().pipeThrough(new DecompressionStream("deflate")).getReader();
  let filled = 0;
  for (;;) {
    const { done, value } = await reader.read();
    if (done) break;
    bytes.set(value, filled);
    filled += value.length;
    onPart(filled / byteCount);
  }
  if (filled !== byteCount) throw new Error("The page is not complete.");
  return bytes;
}

// What a number was foretold by; the order of PackedArrays.
const [NONE, , PREVIOUS_ROW, PREVIOUS_COLUMN] = [0, 1, 2, 3];

/** Tables by name: { rows, columns, column: [typed array] }, each column unsigned. */
export function unpack(tables, bytes) {
  const unpacked = {};
  let place = 0;
  for (const table of tables) {
    const Kind = { 1: Uint8Array, 2: Uint16Array, 4: Uint32Array }[table.bytes];
    const { rows } = table;
    const column = [];
    table.predictions.forEach((prediction, c) => {
      const numbers = new Kind(rows);
      for (let byte = 0; byte < table.bytes; ++byte, place += rows) {
        for (let row = 0; row < rows; ++row) numbers[row] |= bytes[place + row] << (8 * byte);
      }
      if (prediction !== NONE) {
        const left = prediction === PREVIOUS_COLUMN ? column[c - 1] : null;
        let previous = 0;
        for (let row = 0; row < rows; ++row) {
          const folded = numbers[row];
          const foretold = left ? left[row] : prediction === PREVIOUS_ROW ? previous : 0;
          numbers[row] = foretold + ((folded >>> 1) ^ -(folded & 1));
          previous = numbers[row];
        }
      }
      column.push(numbers);
    });
    unpacked[table.name] = { rows, columns: table.columns, column };
  }
  return unpacked;
}
