// SPDX-License-Identifier: MIT
// What the pages that draw splats share: the view that is asked for, in view.json beside the page.
import { Matrix4, PerspectiveCamera } from 'three';

export async function askedView() {
  return (await fetch('view.json')).json();
}

export async function bytesOf(file) {
  return (await fetch(file)).arrayBuffer();
}

/** A camera that stands and projects as said; matrices are row by row. */
export function cameraOf({ world_from_camera, clip_from_camera }) {
  const camera = new PerspectiveCamera();
  new Matrix4().set(...world_from_camera).decompose(camera.position, camera.quaternion, camera.scale);
  camera.updateMatrixWorld();
  camera.projectionMatrix.set(...clip_from_camera);
  camera.projectionMatrixInverse.copy(camera.projectionMatrix).invert();
  return camera;
}

/** Draws often enough that sorting in the background has come to rest. */
export async function drawUntilSorted(draw) {
  for (let i = 0; i < 12; ++i) {
    await draw();
    await new Promise((done) => setTimeout(done, 100));
  }
  window.isDrawn = true;
}
