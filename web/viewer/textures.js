// SPDX-License-Identifier: MIT
// Lists of texels, which native shaders read from buffer textures, as textures of two dimensions.

// A power of two, so that a place in the list is a row and a column by shifts; every WebGL 2 has it.
export const WIDTH_BITS = 11;
const WIDTH = 1 << WIDTH_BITS;

const scratch = new DataView(new ArrayBuffer(4));

/** The nearest half float, as bits. */
function half(value) {
  scratch.setFloat32(0, value);
  const bits = scratch.getUint32(0);
  const sign = (bits >>> 16) & 0x8000;
  const magnitude = bits & 0x7fffffff;
  if (magnitude >= 0x47800000) return sign | 0x7bff;
  if (magnitude < 0x38800000) return sign | Math.round(Math.abs(value) * 16777216);
  return sign | ((magnitude - 0x38000000 + 0xfff + ((magnitude >>> 13) & 1)) >>> 13);
}

/** Halves of all multiples of a step, by the 16 bits of the multiple. */
function halvesOf(step) {
  const halves = new Uint16Array(65536);
  for (let k = -32768; k < 32768; ++k) halves[k & 0xffff] = half(k * step);
  return halves;
}

function upload(gl, internal, format, type, texels, perTexel) {
  const height = Math.max(1, Math.ceil(texels.length / perTexel / WIDTH));
  if (height > gl.getParameter(gl.MAX_TEXTURE_SIZE)) {
    throw new Error("This model is larger than this device’s graphics can hold.");
  }
  const padded = new texels.constructor(WIDTH * height * perTexel);
  padded.set(texels);
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
  gl.texStorage2D(gl.TEXTURE_2D, 1, internal, WIDTH, height);
  gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, WIDTH, height, format, type, padded);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  return texture;
}

/** Coefficients of the patches, half floats. */
export function patchTexture(gl, table, { step, lastStep }) {
  const halves = halvesOf(step);
  const lastHalves = halvesOf(lastStep);
  const texels = new Uint16Array(table.rows * table.columns);
  table.column.forEach((numbers, c) => {
    const known = c % 4 === 3 ? lastHalves : halves;
    for (let row = 0, i = c; row < table.rows; ++row, i += table.columns) texels[i] = known[numbers[row]];
  });
  return upload(gl, gl.RGBA16F, gl.RGBA, gl.HALF_FLOAT, texels, 4);
}

/**
 * How triangles blend anchors, as render/detail/detail.glsl reads it. `corners`: the vertices of all triangles;
 * `positions`, `normals`: of the vertices.
 */
export function blendTexture(gl, { anchors, anchorVertices, blended, blendWeights }, { texels, mirrored }, corners, positions, normals) {
  const lists = [];
  const ofTriangles = [];
  const says = (anchor) => (anchors.column[3][anchor] & 63) !== 0;  // more than the constant, which is zero
  for (let first = 0; first < corners.length; first += 3) {
    // Gather what the corners blend.
    const weights = new Map();
    for (let corner = 0; corner < 3; ++corner) {
      blended.column.forEach((column, i) => {
        const vertex = corners[first + corner];
        const weight = blendWeights.column[i][vertex] / 65535;
        if (weight === 0 || !says(column[vertex])) return;
        if (!weights.has(column[vertex])) weights.set(column[vertex], [0, 0, 0]);
        weights.get(column[vertex])[corner] = weight;
      });
    }
    // Say where the list begins and ends.
    const numbers = [lists.length / 4, lists.length / 4 + weights.size, 0];
    weights.forEach((ofCorners, anchor) => lists.push(anchor, ...ofCorners));
    for (let corner = 0; corner < 3; ++corner) {
      const p = 3 * corners[first + corner];
      ofTriangles.push(positions[p], positions[p + 1], positions[p + 2], numbers[corner]);
    }
  }
  const ofAnchors = Array.from(anchorVertices.column[0]).flatMap((vertex) => [...normals.subarray(3 * vertex, 3 * vertex + 3), 0]);
  const header = [mirrored ? -1 : 1, corners.length / 3, lists.length / 4, texels];
  const all = new Float32Array(4 + ofTriangles.length + lists.length + ofAnchors.length);
  all.set(header);
  all.set(ofTriangles, 4);
  all.set(lists, 4 + ofTriangles.length);
  all.set(ofAnchors, 4 + ofTriangles.length + lists.length);
  return upload(gl, gl.RGBA32F, gl.RGBA, gl.FLOAT, all, 4);
}

/** The dictionary of sparse patches: centre u, v; 1 / support. */
export function atomTexture(gl, atoms) {
  const texels = new Float32Array(atoms.flatMap(([u, v, support]) => [u, v, 1 / support, 0]));
  return upload(gl, gl.RGBA32F, gl.RGBA, gl.FLOAT, texels, 4);
}

/** Mean colours, one texel per patch. */
export function meanTexture(gl, table) {
  const texels = new Uint8Array(4 * table.rows);
  for (let c = 0; c < 3; ++c) {
    for (let row = 0; row < table.rows; ++row) texels[4 * row + c] = table.column[c][row];
  }
  return upload(gl, gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE, texels, 4);
}

/** Confidence, 64 cells per patch: [patch][cell], bytes. */
export function confidenceCells(table) {
  const cells = new Uint8Array(64 * table.rows);
  table.column.forEach((numbers, c) => {
    for (let row = 0; row < table.rows; ++row) cells[64 * row + c] = numbers[row];
  });
  return cells;
}
export const confidenceTexture = (gl, cells) => upload(gl, gl.R8, gl.RED, gl.UNSIGNED_BYTE, cells, 1);

/** The picture over the surface, as it is: no colour management, no turning. */
export async function surfaceTexture(gl, blob) {
  const image = await createImageBitmap(blob, { colorSpaceConversion: "none", premultiplyAlpha: "none" });
  if (Math.max(image.width, image.height) > gl.getParameter(gl.MAX_TEXTURE_SIZE)) {
    throw new Error("This model’s texture is larger than this device’s graphics can hold.");
  }
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA8, image.width, image.height);
  gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, gl.RGBA, gl.UNSIGNED_BYTE, image);
  for (const [name, value] of [[gl.TEXTURE_MIN_FILTER, gl.LINEAR], [gl.TEXTURE_MAG_FILTER, gl.LINEAR],
                               [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE]]) {
    gl.texParameteri(gl.TEXTURE_2D, name, value);
  }
  return texture;
}
