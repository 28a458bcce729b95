// SPDX-License-Identifier: MIT
// Splats drawn by Spark.
import { SparkRenderer, SplatMesh } from '@sparkjsdev/spark';
import { Scene, WebGLRenderer } from 'three';
import { askedView, bytesOf, cameraOf, drawUntilSorted } from './splat_view.js';

const view = await askedView();
const renderer = new WebGLRenderer({ antialias: false });
renderer.setSize(view.width, view.height);
renderer.setClearColor(0x000000);
document.body.append(renderer.domElement);
const scene = new Scene();
scene.add(new SparkRenderer({ renderer }));
const splats = new SplatMesh({ fileBytes: await bytesOf(view.file), fileName: view.file });
await splats.initialized;
scene.add(splats);
const camera = cameraOf(view);
await drawUntilSorted(() => renderer.render(scene, camera));
