// SPDX-License-Identifier: MIT
// A camera that goes round the object: azimuth and elevation about the upright axis, as in
// app/preview/orbit_camera. Object frame, metres.

const HALF_HEIGHT = 0.3153;  // tan(35 degrees / 2)
const HIGHEST = 1.5607;      // half a degree short of the pole
const FILL = 0.86;           // share of the picture that the object's sphere takes

const add = (a, b, s = 1) => a.map((x, i) => x + s * b[i]);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => a.map((x) => x / Math.hypot(...a));
const between = (x, least, most) => Math.min(Math.max(x, least), most);

/** Two level axes and the upright one, right-handed; `name`: "z", "-y", ... */
function uprightAxes(name) {
  const up = ["x", "y", "z"].map((axis) => (name.endsWith(axis) ? (name.startsWith("-") ? -1 : 1) : 0));
  const helper = up[0] === 0 ? [1, 0, 0] : [0, 1, 0];
  return [helper, cross(up, helper), up];
}

export class OrbitCamera {
  /** `home`: azimuth and elevation that it begins with, radians. */
  constructor(centre, radius, up, home) {
    this.axes = uprightAxes(up);
    this.centre = centre;
    this.radius = radius;
    this.aspect = 1;
    this.lift = 0;  // share of the height, at the bottom, that the object keeps clear of
    this.home = { ...home };
    this.reset();
  }

  reset() {
    Object.assign(this, this.home, { target: [...this.centre], zoomed: 1 });
  }

  /** Distance at which the whole object is seen, whichever side of the picture is shorter. */
  get wholeDistance() {
    return this.radius / (FILL * Math.sin(Math.atan(HALF_HEIGHT * Math.min(1 - this.lift, this.aspect))));
  }
  get distance() { return this.wholeDistance * this.zoomed; }
  get back() {
    const level = Math.cos(this.elevation);
    const parts = [level * Math.cos(this.azimuth), level * Math.sin(this.azimuth), Math.sin(this.elevation)];
    return this.axes.reduce((sum, axis, i) => add(sum, axis, parts[i]), [0, 0, 0]);
  }
  get eye() { return add(this.target, this.back, this.distance); }

  /** By shares of the picture's height. */
  orbit(x, y) {
    this.azimuth -= Math.PI * x;
    this.elevation = between(this.elevation + Math.PI * y, -HIGHEST, HIGHEST);
  }
  pan(x, y) {
    const right = unit(cross(this.axes[2], this.back));
    const up = cross(this.back, right);
    const height = 2 * HALF_HEIGHT * this.distance;
    this.target = add(add(this.target, right, -x * height), up, y * height);
  }
  zoom(factor) { this.zoomed = between(this.zoomed * factor, 0.02, 8); }

  /** Column-major, as OpenGL has it. */
  clipFromObject() {
    const { back, eye } = this;
    const right = unit(cross(this.axes[2], back));
    const up = cross(back, right);
    const near = Math.max(this.distance - 3 * this.radius - Math.hypot(...add(this.target, this.centre, -1)), 0.003 * this.radius);
    const far = near + 8 * this.radius + this.distance + Math.hypot(...add(this.target, this.centre, -1));
    const sx = 1 / (HALF_HEIGHT * this.aspect);
    const sy = 1 / HALF_HEIGHT;
    const a = (far + near) / (far - near);
    const b = -2 * far * near / (far - near);
    const rows = [[...right, -dot(right, eye)].map((x) => sx * x), [...up, -dot(up, eye)].map((x) => sy * x),
                  [...back.map((x) => -a * x), a * dot(back, eye) + b], [...back.map((x) => -x), dot(back, eye)]];
    rows[1] = add(rows[1], rows[3], this.lift);
    return Float32Array.from({ length: 16 }, (_, i) => rows[i % 4][i >> 2]);
  }
}
