// SPDX-License-Identifier: MIT
// Splats drawn by three.js' own GaussianSplat.
import { Color, LinearSRGBColorSpace, Scene, WebGPURenderer } from 'three/webgpu';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { GLTFGaussianSplatLoaderExtension } from 'three/addons/loaders/GLTFGaussianSplatLoaderExtension.js';
import { GaussianSplatPLYLoader } from 'three/addons/loaders/GaussianSplatPLYLoader.js';
import { SPZLoader } from 'three/addons/loaders/SPZLoader.js';
import { GaussianSplat } from 'three/addons/objects/GaussianSplat.js';
import { askedView, bytesOf, cameraOf, drawUntilSorted } from './splat_view.js';

async function splatsOf(file) {
  if (file.endsWith('.ply')) return new GaussianSplat(new GaussianSplatPLYLoader().parse(await bytesOf(file)));
  if (file.endsWith('.spz')) return new GaussianSplat(await new SPZLoader().loadAsync(file));
  const loader = new GLTFLoader();
  loader.register((parser) => new GLTFGaussianSplatLoaderExtension(parser));
  return (await loader.loadAsync(file)).scene;
}

const view = await askedView();
const renderer = new WebGPURenderer({ forceWebGL: true });
renderer.outputColorSpace = LinearSRGBColorSpace;  // harmonics give what is displayed already
await renderer.init();
renderer.setSize(view.width, view.height);
document.body.append(renderer.domElement);
const scene = new Scene();
scene.background = new Color(0x000000);
scene.add(await splatsOf(view.file));
const camera = cameraOf(view);
await drawUntilSorted(() => renderer.renderAsync(scene, camera));
