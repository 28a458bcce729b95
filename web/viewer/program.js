// SPDX-License-Identifier: MIT
// The shaders: the mathematics of each representation is the renderer's own file.
import direction from "../../render/shaders/direction.glsl";
import detail from "../../render/detail/detail.glsl";
import harmonics from "../../render/spherical_harmonics/harmonics.glsl";
import iwls from "../../render/iwls/iwls.glsl";
import mean from "../../render/mean/mean.glsl";
import sparse from "../../render/sparse/sparse.glsl";
import surfaceFragment from "./surface_fragment.glsl";
import surfaceVertex from "./surface_vertex.glsl";
import { WIDTH_BITS } from "./textures.js";

const EVALUATE = { harmonics, iwls, mean, sparse };

const real = (x) => {
  const text = String(x);
  return /[.e]/.test(text) ? text : `${text}.0`;
};

/** What the renderer writes in front of a representation's shader. */
const HEADERS = {
  mean: () => "",
  harmonics: ({ texels }) => `#define TERMS ${texels}\n`,
  sparse: (_, patches) => `#define PATCH_COUNT ${patches}\n`,
  iwls: ({ centers, terms, supportRadius }) => {
    const quads = centers.length / 4;
    const list = (name, axis) => {
      const vectors = Array.from({ length: quads }, (_, q) =>
        `vec4(${[0, 1, 2, 3].map((lane) => real(centers[4 * q + lane][axis])).join(", ")})`);
      return `const vec4 ${name}[QUADS] = vec4[QUADS](${vectors.join(", ")});\n`;
    };
    return `#define QUADS ${quads}\n#define TERMS ${terms}\n#define INVERSE_SUPPORT ${real(1 / supportRadius)}\n` +
      list("centre_u", 0) + list("centre_v", 1);
  },
};

// Buffer textures, which WebGL does not have, as textures of two dimensions.
const lists = (patch, patches) => `
vec4 texel_of_list(sampler2D list, int i) {
  return texelFetch(list, ivec2(i & ${(1 << WIDTH_BITS) - 1}, i >> ${WIDTH_BITS}), 0);
}
#define samplerBuffer sampler2D
#define texelFetch(list, i) texel_of_list(list, i)
#define textureSize(list) ${patches * patch.texels}
`;

const withoutBindings = (text) => text.replace(/layout\(binding = \d+\) /g, "");

function compile(gl, kind, text) {
  const shader = gl.createShader(kind);
  gl.shaderSource(shader, text);
  gl.compileShader(shader);
  return shader;
}

/** The program of a model; `features`: names to be defined (TEXTURED, BETWEEN, MEANS, CONFIDENCE). */
export function surfaceProgram(gl, patch, patches, features) {
  const head = `#version 300 es\nprecision highp float;\nprecision highp int;\nprecision highp sampler2D;\n` +
    features.map((name) => `#define ${name}\n`).join("");
  const evaluate = HEADERS[patch.shader](patch, patches) + withoutBindings(EVALUATE[patch.shader]);
  const program = gl.createProgram();
  const evaluated = "uniform vec4 eye_and_near;\n" + lists(patch, patches) + direction + evaluate;
  const between = features.includes("BETWEEN") ? evaluated + withoutBindings(detail) : "";
  const vertex = compile(gl, gl.VERTEX_SHADER, head + evaluated + surfaceVertex);
  const fragment = compile(gl, gl.FRAGMENT_SHADER, head + between + surfaceFragment);
  gl.attachShader(program, vertex);
  gl.attachShader(program, fragment);
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
    throw new Error(`This device’s graphics refused the model’s shader. ${gl.getProgramInfoLog(program) ||
      ""}${gl.getShaderInfoLog(vertex) || ""}${gl.getShaderInfoLog(fragment) || ""}`);
  }
  return program;
}
