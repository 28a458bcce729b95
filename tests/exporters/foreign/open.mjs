// SPDX-License-Identifier: MIT
// Opens exported files with programs that this project did not write: three.js' loaders and Khronos'
// glTF validator. Prints what they found as JSON, one object per file.
// Usage: node open.mjs FILE ...
import { readFileSync } from 'node:fs';
import { basename } from 'node:path';
import validator from 'gltf-validator';

// What loaders expect of a browser.
globalThis.self = globalThis;
globalThis.createImageBitmap = async (blob) => {
  const header = new DataView(await blob.arrayBuffer());
  return { width: header.getUint32(16), height: header.getUint32(20), close() {} };
};

const addons = 'three/addons/loaders';
const { GLTFLoader } = await import(`${addons}/GLTFLoader.js`);
const { GLTFGaussianSplatLoaderExtension } = await import(`${addons}/GLTFGaussianSplatLoaderExtension.js`);
const { GaussianSplatPLYLoader } = await import(`${addons}/GaussianSplatPLYLoader.js`);
const { SPZLoader } = await import(`${addons}/SPZLoader.js`);
const { PLYLoader } = await import(`${addons}/PLYLoader.js`);
const { OBJLoader } = await import(`${addons}/OBJLoader.js`);
const { USDLoader } = await import(`${addons}/USDLoader.js`);

const bytesOf = (path) => {
  const bytes = readFileSync(path);
  return bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
};

function meshFacts(geometry) {
  const position = geometry.getAttribute('position');
  geometry.computeBoundingBox();
  const { min, max } = geometry.boundingBox;
  const colour = geometry.getAttribute('color');
  const place = geometry.getAttribute('uv');
  const facts = {
    vertices: position.count,
    triangles: (geometry.index ? geometry.index.count : position.count) / 3,
    lowest: min.toArray(),
    highest: max.toArray(),
    normals: geometry.getAttribute('normal')?.count ?? 0,
    places: place?.count ?? 0,
  };
  if (colour) facts.firstColour = [0, 1, 2].map((c) => colour.getComponent(0, c));  // linear
  return facts;
}

function splatFacts(geometry) {
  const facts = { attributes: {} };
  for (const [name, attribute] of Object.entries(geometry.attributes)) {
    facts.attributes[name] = { size: attribute.itemSize, count: attribute.count,
      values: Array.from(attribute.array.slice(0, 40 * attribute.itemSize)) };
  }
  return facts;
}

function firstOf(scene, test) {
  let found = null;
  scene.traverse((object) => { found ??= test(object) ? object : null; });
  return found;
}

async function openGlb(path) {
  const bytes = bytesOf(path);
  const report = await validator.validateBytes(new Uint8Array(bytes));
  const loader = new GLTFLoader();
  loader.register((parser) => new GLTFGaussianSplatLoaderExtension(parser));
  const gltf = await loader.parseAsync(bytes, '');
  const object = firstOf(gltf.scene, (o) => o.geometry !== undefined);
  const facts = object.splatGeometry ? splatFacts(object.splatGeometry) : meshFacts(object.geometry);
  const image = object.material?.map?.image;
  if (image) facts.texture = [image.width, image.height];
  facts.material = object.material?.type;
  facts.validator = { errors: report.issues.numErrors, warnings: report.issues.numWarnings,
    messages: report.issues.messages.filter((m) => m.severity === 0).map((m) => `${m.code} ${m.pointer}`) };
  return facts;
}

async function open(path) {
  if (path.endsWith('.glb')) return openGlb(path);
  if (path.endsWith('.splat.ply')) return splatFacts(new GaussianSplatPLYLoader().parse(bytesOf(path)));
  if (path.endsWith('.spz')) {
    return splatFacts(await new Promise((resolve, reject) => {
      const parsed = new SPZLoader().parse(bytesOf(path), resolve, reject);
      if (parsed?.attributes) resolve(parsed);
    }));
  }
  if (path.endsWith('.ply')) return meshFacts(new PLYLoader().parse(bytesOf(path)));
  if (path.endsWith('.obj')) {
    const scene = new OBJLoader().parse(readFileSync(path, 'utf8'));
    const object = firstOf(scene, (o) => o.isMesh);
    return { ...meshFacts(object.geometry), material: object.material.name };
  }
  if (path.endsWith('.usda')) {
    const scene = new USDLoader().parse(readFileSync(path, 'utf8'));
    const object = firstOf(scene, (o) => o.isMesh);
    // The loader paints the whole mesh with the first of the colours.
    return { ...meshFacts(object.geometry), firstColour: object.material.color.toArray() };
  }
  throw new Error(`no reader for ${path}`);
}

const found = {};
for (const path of process.argv.slice(2)) found[basename(path)] = await open(path);
console.log(JSON.stringify(found));
