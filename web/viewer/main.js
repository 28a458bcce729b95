// SPDX-License-Identifier: MIT
// The page: load, show progress, draw when something changed.
import { OrbitCamera } from "./camera.js";
import { controlByKeys, controlByPointer } from "./controls.js";
import { blobOf, inflate, pageLoaded, unpack } from "./payload.js";
import { Surface } from "./surface.js";
import { surfaceTexture } from "./textures.js";

const byId = (id) => document.getElementById(id);
const grouped = (x) => x.toLocaleString("en").replace(/,/g, "\u2009");

function showProgress(part) {
  const percent = Math.round(100 * Math.min(part, 1));
  byId("loading").style.setProperty("--part", `${percent}%`);
  byId("loading").setAttribute("aria-valuenow", percent);
}

function showFault(text) {
  document.body.dataset.fault = "";
  byId("loading").hidden = true;
  byId("fault").textContent = text;
  byId("fault").hidden = false;
}

// Backgrounds: those everybody has, and the page's own colour.
const GROUNDS = {
  dark: ["dark", "radial-gradient(circle at 50% 42%, #2b3340 0%, #171c24 58%, #0e1217 100%)"],
  light: ["light", "radial-gradient(circle at 50% 42%, #ffffff 0%, #eef1f4 55%, #d5dbe2 100%)"],
  black: ["dark", "#000"],
  white: ["light", "#fff"],
};
function groundOf(name) {
  if (GROUNDS[name]) return GROUNDS[name];
  const [r, g, b] = [1, 3, 5].map((i) => parseInt(name.slice(i, i + 2), 16));
  return [0.299 * r + 0.587 * g + 0.114 * b > 140 ? "light" : "dark", name];
}
function showGround(name) {
  const [tone, ground] = groundOf(name);
  document.documentElement.dataset.tone = tone;
  document.documentElement.style.setProperty("--ground", ground);
}

function tellFacts({ facts }) {
  const mb = (document.documentElement.dataset.bytes = performance.getEntriesByType("navigation")[0]?.decodedBodySize || 0) / 1e6;
  byId("facts").textContent = [
    `${grouped(facts.patches)} patches`,
    facts.texture ? `texture ${facts.texture.join(" × ")}` : "",
    `${facts.size_mm.join(" × ")} mm`,
    mb > 0 ? `${mb.toFixed(1)} MB` : "",
  ].filter(Boolean).join(" · ");
  byId("details").textContent = `Representation ${facts.representation}: ${grouped(facts.numbers)} numbers over ` +
    `${grouped(facts.patches)} patches, of which ${grouped(facts.observed)} were photographed, on ${grouped(facts.triangles)} triangles.`;
}

class Viewer {
  constructor(canvas, gl, model, surface) {
    Object.assign(this, { canvas, gl, model, surface });
    this.camera = new OrbitCamera(surface.centre, surface.radius, model.up, model.home);
    this.split = 0.5;
    this.comparing = this.confidence = this.turning = false;
    this.fading = true;
    this.ground = model.background;
    this.takeAddress();
    if (!surface.cells) {
      byId("confidence").hidden = true;
      byId("fading").hidden = true;
    }
    this.connect();
  }

  /** What the address says after #: azimuth, elevation, zoom, bare, fading, compare, confidence. */
  takeAddress() {
    const asked = new URLSearchParams(location.hash.slice(1));
    for (const name of ["azimuth", "elevation"]) {
      if (asked.has(name)) this.camera[name] = this.camera.home[name] = Number(asked.get(name)) || 0;
    }
    if (asked.has("zoom")) this.camera.zoomed = Number(asked.get("zoom")) || 1;
    if (asked.has("bare")) document.body.dataset.bare = "";
    if (asked.get("fading") === "no") this.fading = false;
    if (asked.has("compare")) this.comparing = true;
    if (asked.has("confidence")) this.confidence = true;
    if (asked.has("background")) this.ground = asked.get("background");
  }

  connect() {
    const { camera, canvas } = this;
    const changed = (byHand) => {
      if (byHand) this.turning = false;
      this.ask();
    };
    controlByPointer(canvas, camera, changed);
    const grounds = [...new Set([this.model.background, ...Object.keys(GROUNDS)])];
    const actions = {
      t: () => { this.turning = !this.turning; },
      c: () => { this.comparing = !this.comparing; },
      v: () => { if (this.surface.cells) this.confidence = !this.confidence; },
      b: () => { this.ground = grounds[(grounds.indexOf(this.ground) + 1) % grounds.length]; },
      r: () => { this.turning = false; camera.reset(); },
      "?": () => { byId("about").hidden = !byId("about").hidden; },
      escape: () => { byId("about").hidden = true; },
    };
    const run = (action) => () => { action(); this.ask(); };
    controlByKeys(camera, changed, Object.fromEntries(Object.entries(actions).map(([key, action]) => [key, run(action)])));
    for (const [id, key] of [["turn", "t"], ["compare", "c"], ["confidence", "v"], ["background", "b"], ["reset", "r"], ["help", "?"]]) {
      byId(id).addEventListener("click", run(actions[key]));
    }

    // The line between mean colours and light field.
    const split = byId("split");
    const moveSplit = (x) => {
      this.split = Math.min(Math.max(x, 0.02), 0.98);
      this.ask();
    };
    split.addEventListener("pointerdown", (event) => split.setPointerCapture(event.pointerId));
    split.addEventListener("pointermove", (event) => {
      if (event.buttons) moveSplit(event.clientX / canvas.clientWidth);
    });
    split.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: -0.03, ArrowRight: 0.03 }[event.key];
      if (step) moveSplit(this.split + step);
    });
    new ResizeObserver(() => this.ask()).observe(canvas);
    canvas.addEventListener("webglcontextlost", () => showFault("The graphics of this device gave up the picture. Load the page again."));
  }

  /** Draws before the next picture of the screen, once. */
  ask() {
    this.asked ??= requestAnimationFrame((time) => {
      this.asked = null;
      this.frame(time);
    });
  }

  frame(time) {
    const TURN = 2 * Math.PI / 20000;  // once round in 20 seconds
    if (this.turning) {
      this.camera.azimuth += TURN * Math.min(time - (this.lastTime ?? time), 100);
      this.ask();
    }
    this.lastTime = this.turning ? time : undefined;
    this.draw();
    this.tell();
  }

  draw() {
    const { canvas } = this;
    const density = Math.min(window.devicePixelRatio, 2);
    const width = Math.max(1, Math.round(canvas.clientWidth * density));
    const height = Math.max(1, Math.round(canvas.clientHeight * density));
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    this.camera.aspect = width / height;
    this.camera.lift = "bare" in document.body.dataset ? 0 : Math.min(84 / canvas.clientHeight, 0.3);  // the tools
    this.surface.draw(this.camera, {
      split: this.comparing ? this.split : -1, confidence: this.confidence, fading: this.fading });
  }

  tell() {
    const pressed = (id, on) => byId(id).setAttribute("aria-pressed", on);
    pressed("turn", this.turning);
    pressed("compare", this.comparing);
    pressed("confidence", this.confidence);
    byId("help").setAttribute("aria-expanded", !byId("about").hidden);
    byId("legend").hidden = !this.confidence;
    byId("split").hidden = !this.comparing;
    byId("split").style.left = `${100 * this.split}%`;
    byId("split").setAttribute("aria-valuenow", Math.round(100 * this.split));
    showGround(this.ground);

    // Say so where much of what is seen is no more than a mean colour.
    const missing = Math.round(100 * (1 - this.surface.supportedFrom(this.camera.eye)));
    const told = byId("told");
    told.hidden = !(this.fading && missing >= 25);
    told.textContent = `Hardly anybody looked from here: ${missing} % of what you see fades to its mean colour.`;
  }
}

async function start() {
  const model = JSON.parse(byId("model").textContent);
  showGround(model.background);
  const canvas = byId("picture");
  const gl = canvas.getContext("webgl2", { alpha: true, antialias: true, powerPreference: "high-performance" });
  if (!gl) throw new Error("This browser cannot draw the model: it has no WebGL\u00a02. A current Firefox, Chrome, Edge or Safari has it.");
  if (!window.DecompressionStream) throw new Error("This browser is too old to unpack the model. A current Firefox, Chrome, Edge or Safari can.");
  await pageLoaded(model.pieces, (part) => showProgress(0.7 * part));
  tellFacts(model);
  const texture = model.facts.texture ? await surfaceTexture(gl, blobOf("texture", "image/png")) : null;
  const bytes = await inflate(model.unpackedBytes, (part) => showProgress(0.7 + 0.3 * part));
  const surface = new Surface(gl, model, unpack(model.tables, bytes), texture);
  const viewer = new Viewer(canvas, gl, model, surface);
  viewer.draw();
  viewer.tell();
  delete document.body.dataset.loading;
  byId("loading").hidden = true;
  performance.mark("first-picture");
  canvas.focus({ preventScroll: true });
}

start().catch((fault) => showFault(fault.message));
