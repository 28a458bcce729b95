// SPDX-License-Identifier: MIT
// The mesh: from tables to buffers, and drawn.
import { surfaceProgram } from "./program.js";
import * as textures from "./textures.js";

function positionsOf(table, { lowest, step }) {
  const positions = new Float32Array(3 * table.rows);
  for (let axis = 0; axis < 3; ++axis) {
    for (let row = 0; row < table.rows; ++row) positions[3 * row + axis] = lowest[axis] + step * table.column[axis][row];
  }
  return positions;
}

/** Normals from the octahedron; the sign of z stays even where z is zero. */
function normalsOf(table) {
  const normals = new Float32Array(3 * table.rows);
  const [xs, ys, signs] = table.column;
  for (let row = 0; row < table.rows; ++row) {
    const x = xs[row] / 32767 - 1;
    const y = ys[row] / 32767 - 1;
    const z = Math.max(1 - Math.abs(x) - Math.abs(y), 0);
    const length = Math.hypot(x, y, z) || 1;
    normals[3 * row] = x / length;
    normals[3 * row + 1] = y / length;
    normals[3 * row + 2] = (signs[row] ? -z : z) / length;
  }
  return normals;
}

/** Vertices repeated where the texture has a seam. */
function withCopies(values, perVertex, copies) {
  if (!copies) return values;
  const all = new values.constructor(values.length + copies.length * perVertex);
  all.set(values);
  copies.forEach((vertex, i) => {
    all.set(values.subarray(vertex * perVertex, (vertex + 1) * perVertex), values.length + i * perVertex);
  });
  return all;
}

/** Values of vertices, one after another for the corners of all triangles. */
function atCorners(values, perVertex, triangles) {
  const all = new values.constructor(triangles.length * perVertex);
  triangles.forEach((vertex, corner) => {
    for (let i = 0; i < perVertex; ++i) all[corner * perVertex + i] = values[vertex * perVertex + i];
  });
  return all;
}

function interleaved(columns) {
  const all = new columns[0].constructor(columns[0].length * columns.length);
  columns.forEach((column, c) => column.forEach((x, row) => { all[row * columns.length + c] = x; }));
  return all;
}

export class Surface {
  constructor(gl, model, tables, texture) {
    this.gl = gl;
    this.patches = tables.positions.rows;
    this.positions = positionsOf(tables.positions, model.surface);
    this.normals = normalsOf(tables.normals);
    this.cells = tables.confidence ? textures.confidenceCells(tables.confidence) : null;
    this.measure();
    this.makeBuffers(tables, Boolean(model.anchors));

    // Textures, each in a unit of its own.
    // The renderer's shaders have names of their own for the first.
    const patches = { sparse: "patch_terms", mean: "patch_colours" }[model.patch.shader] || "patch_coefficients";
    this.textures = [[patches, textures.patchTexture(gl, tables.patches, model.patch)]];
    if (model.patch.atoms) this.textures.push(["atoms", textures.atomTexture(gl, model.patch.atoms)]);
    if (model.anchors) {
      this.textures.push(["anchor_terms", textures.patchTexture(gl, tables.anchors, model.anchors)]);
      this.textures.push(["blends", textures.blendTexture(gl, tables, model.anchors, this.corners, this.positions, this.normals)]);
    }
    if (tables.means) this.textures.push(["patch_means", textures.meanTexture(gl, tables.means)]);
    if (this.cells) this.textures.push(["patch_confidence", textures.confidenceTexture(gl, this.cells)]);
    if (texture) this.textures.push(["surface_texture", texture]);
    const features = [texture && "TEXTURED", model.anchors && "BETWEEN", tables.means && "MEANS", this.cells && "CONFIDENCE"].filter(Boolean);
    this.program = surfaceProgram(gl, model.patch, this.patches, features);
    const names = ["clip_from_object", "eye_and_near", "split_px", "show_confidence", "fading", ...this.textures.map(([name]) => name)];
    this.uniforms = Object.fromEntries(names.map((name) => [name, gl.getUniformLocation(this.program, name)]));
  }

  /** Centre and radius of the sphere that pictures are framed by. */
  measure() {
    const low = [Infinity, Infinity, Infinity];
    const high = [-Infinity, -Infinity, -Infinity];
    this.positions.forEach((x, i) => {
      low[i % 3] = Math.min(low[i % 3], x);
      high[i % 3] = Math.max(high[i % 3], x);
    });
    this.centre = low.map((x, i) => (x + high[i]) / 2);
    this.radius = 1e-6;
    for (let i = 0; i < this.positions.length; i += 3) {
      this.radius = Math.max(this.radius, Math.hypot(...this.centre.map((x, k) => this.positions[i + k] - x)));
    }
  }

  /** `apart`: corner by corner, so that the shader knows its triangle. */
  makeBuffers(tables, apart) {
    const { gl } = this;
    const copies = tables.copies?.column[0];
    const triangles = interleaved(tables.triangles.column);
    this.corners = triangles.map((vertex) => (vertex < this.patches ? vertex : copies[vertex - this.patches]));
    this.indexCount = triangles.length;
    this.isApart = apart;
    const own = Uint32Array.from({ length: this.patches }, (_, i) => i);
    gl.bindVertexArray(gl.createVertexArray());
    const attribute = (location, perVertex, values, define) => {
      const data = apart ? atCorners(values, perVertex, triangles) : values;
      gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
      gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
      gl.enableVertexAttribArray(location);
      define(location);
    };
    attribute(0, 3, withCopies(this.positions, 3, copies), (l) => gl.vertexAttribPointer(l, 3, gl.FLOAT, false, 0, 0));
    attribute(1, 3, withCopies(this.normals, 3, copies), (l) => gl.vertexAttribPointer(l, 3, gl.FLOAT, false, 0, 0));
    attribute(2, 1, withCopies(own, 1, copies), (l) => gl.vertexAttribIPointer(l, 1, gl.UNSIGNED_INT, 0, 0));
    if (tables.places) {
      attribute(3, 2, interleaved(tables.places.column),
                (l) => gl.vertexAttribPointer(l, 2, gl.UNSIGNED_SHORT, true, 0, 0));
    }
    if (apart) return;
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, triangles, gl.STATIC_DRAW);
  }

  draw(camera, { split, confidence, fading }) {
    const { gl, uniforms } = this;
    gl.viewport(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.CULL_FACE);
    gl.useProgram(this.program);
    this.textures.forEach(([name, texture], unit) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.uniform1i(uniforms[name], unit);
    });
    gl.uniformMatrix4fv(uniforms.clip_from_object, false, camera.clipFromObject());
    gl.uniform4f(uniforms.eye_and_near, ...camera.eye, 0);
    gl.uniform1f(uniforms.split_px, split * gl.drawingBufferWidth);
    gl.uniform1i(uniforms.show_confidence, confidence ? 1 : 0);
    gl.uniform1i(uniforms.fading, fading ? 1 : 0);
    if (this.isApart) {
      gl.drawArrays(gl.TRIANGLES, 0, this.indexCount);
    } else {
      gl.drawElements(gl.TRIANGLES, this.indexCount, gl.UNSIGNED_INT, 0);
    }
  }

  /** Share of the surface turned to an eye whose direction has been looked from (or nearly), [0, 1];
   * of about 3000 of its patches. */
  supportedFrom(eye) {
    if (!this.cells) return 1;
    const stride = Math.max(1, Math.floor(this.patches / 3000));
    let facing = 0;
    let supported = 0;
    for (let patch = 0; patch < this.patches; patch += stride) {
      const i = 3 * patch;
      const n = this.normals.subarray(i, i + 3);
      const w = [0, 1, 2].map((k) => eye[k] - this.positions[i + k]);
      const length = Math.hypot(...w);
      const cosine = (w[0] * n[0] + w[1] * n[1] + w[2] * n[2]) / length;
      if (cosine < 0.2) continue;
      // The direction on the patch's disc, as render/shaders/direction.glsl has it.
      const s = n[2] < 0 || Object.is(n[2], -0) ? -1 : 1;
      const a = -1 / (s + n[2]);
      const b = n[0] * n[1] * a;
      const u = (w[0] * (1 + s * n[0] * n[0] * a) + w[1] * s * b - w[2] * s * n[0]) / length;
      const v = (w[0] * b + w[1] * (s + n[1] * n[1] * a) - w[2] * n[1]) / length;
      const cell = (x) => Math.min(Math.max(Math.floor((x + 1) * 4), 0), 7);
      facing += cosine;
      if (this.cells[64 * patch + 8 * cell(v) + cell(u)] >= 128) supported += cosine;
    }
    return facing > 0 ? supported / facing : 1;
  }
}
