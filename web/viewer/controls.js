// SPDX-License-Identifier: MIT
// Pointers, wheel and keys -> camera. One finger turns, two move and pinch.

export function controlByPointer(canvas, camera, changed) {
  const fingers = new Map();
  const middle = () => {
    const all = [...fingers.values()];
    const mean = (axis) => all.reduce((sum, p) => sum + p[axis], 0) / all.length;
    return { x: mean("x"), y: mean("y"), spread: all.length > 1 ? Math.hypot(all[0].x - all[1].x, all[0].y - all[1].y) : 0 };
  };

  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    changed(true);
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!fingers.has(event.pointerId)) return;
    const before = middle();
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    const now = middle();
    const height = canvas.clientHeight;
    const x = (now.x - before.x) / height;
    const y = (now.y - before.y) / height;
    if (fingers.size > 1 || event.shiftKey || event.buttons & 6) camera.pan(x, y);
    else camera.orbit(x, y);
    if (before.spread > 0 && now.spread > 0) camera.zoom(before.spread / now.spread);
    changed(true);
  });
  for (const name of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(name, (event) => fingers.delete(event.pointerId));
  }
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 30 : 1;
    camera.zoom(Math.exp(Math.min(Math.max(event.deltaY * lines, -240), 240) * 0.0015));
    changed(true);
  }, { passive: false });
}

/** `actions`: what letters do. */
export function controlByKeys(camera, changed, actions) {
  const STEP = 0.04;
  const moves = { ArrowLeft: [-STEP, 0], ArrowRight: [STEP, 0], ArrowUp: [0, -STEP], ArrowDown: [0, STEP] };
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.id === "split") return;
    const letter = event.key.toLowerCase();
    if (moves[event.key]) {
      if (event.shiftKey) camera.pan(...moves[event.key]);
      else camera.orbit(...moves[event.key]);
    } else if (letter === "+" || letter === "=") {
      camera.zoom(0.85);
    } else if (letter === "-") {
      camera.zoom(1 / 0.85);
    } else if (actions[letter]) {
      actions[letter]();
      return;
    } else {
      return;
    }
    event.preventDefault();
    changed(true);
  });
}
