// Animation of a car crossing its bump: a side view that moves with the car, with a slider over
// time. make_motion() (jobs/simulate/motion.h) writes the scene; x forward, z up, in meters.
"use strict";

const svgSpace = "http://www.w3.org/2000/svg";
const viewHeight = 2.4;      // m
const margin = 1.6;          // m ahead of the front and behind the rear wheels
const coils = 7;
const dashes = "0.04 0.03";  // line style of the far (left) side

function addShape(parent, name, attributes) {
  const shape = document.createElementNS(svgSpace, name);
  for (const [key, value] of Object.entries(attributes)) shape.setAttribute(key, value);
  parent.append(shape);
  return shape;
}

function setAll(shape, attributes) {
  for (const [key, value] of Object.entries(attributes)) shape.setAttribute(key, value);
}

const toPoints = (points) => points.map(([x, z]) => x.toFixed(4) + "," + (-z).toFixed(4)).join(" ");

// A sedan's outline: x as a fraction of the wheelbase from the rear axle, z from the ground at rest.
function makeOutline(scene) {
  const base = scene.front.wheel[0] - scene.rear.wheel[0];
  const shape = [[-0.33, 0.35], [-0.36, 0.62], [-0.33, 0.92], [-0.1, 0.98], [0.12, 1.38], [0.3, 1.46],
                 [0.52, 1.44], [0.78, 1.02], [1.12, 0.9], [1.28, 0.72], [1.29, 0.35]];
  return shape.map(([fraction, z]) => [scene.rear.wheel[0] + fraction * base, z - scene.nominal_height]);
}

// A zigzag between two points, straight at its ends.
function makeSpring([x0, z0], [x1, z1]) {
  const length = Math.hypot(x1 - x0, z1 - z0);
  const across = [-(z1 - z0) / length, (x1 - x0) / length];
  const points = [[x0, z0]];
  for (let i = 0; i <= 2 * coils; ++i) {
    const along = 0.15 + 0.7 * i / (2 * coils);  // fraction of the length
    const side = i % 2 === 0 ? 0.06 : -0.06;
    points.push([x0 + along * (x1 - x0) + side * across[0], z0 + along * (z1 - z0) + side * across[1]]);
  }
  points.push([x1, z1]);
  return points;
}

// Angle that a wheel has turned since the start, by the trapezoidal rule [rad].
function integrate(time, speed) {
  let angle = 0;
  return speed.map((w, i) => angle += i === 0 ? 0 : 0.5 * (w + speed[i - 1]) * (time[i] - time[i - 1]));
}

class MotionView {
  constructor(root) {
    this.scene = JSON.parse(root.querySelector("script").textContent);
    this.last = this.scene.time.length - 1;
    this.turned = this.scene.wheel_speed.map((speed) => integrate(this.scene.time, speed));
    this.outline = makeOutline(this.scene);
    this.enlarged = 1;
    this.makePicture(root);
    this.makeControls(root);
    const at = this.scene.snapshot_time;
    const frame = at === null ? 0 : this.scene.time.findIndex((t) => t >= at);
    this.show(frame < 0 ? this.last : frame);
    root.dataset.motion = "drawn";
  }

  makePicture(root) {
    const {front, rear} = this.scene;
    const left = rear.wheel[0] - margin;
    const width = front.wheel[0] + margin - left;
    this.view = {left, width};
    this.svg = addShape(root, "svg", {viewBox: `0 ${-viewHeight + 0.35} ${width} ${viewHeight}`,
                                      role: "img", "aria-label": "side view of the car"});
    const line = {fill: "none", stroke: "var(--ink)", "stroke-width": 0.012, "stroke-linejoin": "round"};
    const ground = {...line, "stroke-width": 0.02, stroke: "var(--soft)"};
    const side = this.scene.road_side;
    this.road = addShape(this.svg, "polyline", side === "left" ? {...ground, "stroke-dasharray": dashes} : ground);
    if (side !== "both") addShape(this.svg, "line", {...ground, x1: -1, y1: 0, x2: width + 1, y2: 0});
    this.marks = addShape(this.svg, "path", {...line, stroke: "var(--soft)"});
    this.body = addShape(this.svg, "polygon", {...line, fill: "var(--accent)", "fill-opacity": 0.15});
    this.reference = addShape(this.svg, "circle", {r: 0.03, fill: "var(--ink)"});
    // Front left, front right, rear left, rear right. The view is from the car's right, so the left
    // wheels are on the far side.
    const far = {"stroke-dasharray": dashes, opacity: 0.5};
    this.wheels = [0, 1, 2, 3].map((corner) => {
      const look = corner % 2 === 0 ? far : {};
      return {rim: addShape(this.svg, "circle", {...line, "stroke-width": 0.03, ...look}),
              spoke: addShape(this.svg, "line", {...line, ...look}),
              spring: addShape(this.svg, "polyline", {...line, stroke: "var(--accent)", ...look})};
    });
  }

  makeControls(root) {
    const bar = document.createElement("div");
    bar.className = "controls";
    this.button = document.createElement("button");
    this.button.type = "button";
    this.button.addEventListener("click", () => this.playing ? this.stop() : this.play());
    this.slider = document.createElement("input");
    Object.assign(this.slider, {type: "range", min: 0, max: this.last, step: 1});
    this.slider.setAttribute("aria-label", "instant");
    this.slider.addEventListener("input", () => { this.stop(); this.show(Number(this.slider.value)); });
    this.output = document.createElement("output");
    this.scale = document.createElement("select");
    this.scale.setAttribute("aria-label", "how much the motion is enlarged");
    for (const times of [1, 3, 10]) this.scale.append(new Option(`motion x ${times}`, times));
    this.scale.addEventListener("change", () => { this.enlarged = Number(this.scale.value); this.show(this.frame); });
    bar.append(this.button, this.slider, this.output, this.scale);
    root.append(bar);
    this.stop();
  }

  // Enlarges the deviation from the first instant.
  enlarge(values, frame) { return values[0] + this.enlarged * (values[frame] - values[0]); }

  show(frame) {
    const scene = this.scene;
    this.frame = frame;
    const x = scene.forward[frame];
    const z = this.enlarge(scene.height, frame);
    const pitch = this.enlarge(scene.pitch, frame);
    const [cos, sin] = [Math.cos(pitch), Math.sin(pitch)];
    // Positive pitch is nose down, so points ahead move down.
    const place = ([px, pz]) => [px * cos + pz * sin - this.view.left, z - px * sin + pz * cos];
    this.body.setAttribute("points", toPoints(this.outline.map(place)));
    const [cx, cz] = place([0, 0]);
    setAll(this.reference, {cx, cy: -cz});
    this.wheels.forEach((wheel, corner) => this.placeWheel(wheel, corner, place, frame));
    this.placeRoad(x);
    this.slider.value = frame;
    this.output.textContent = `${scene.time[frame].toFixed(3)} s, ${x.toFixed(2)} m`;
    markInstant(scene.time[frame]);
  }

  placeWheel({rim, spoke, spring}, corner, place, frame) {
    const scene = this.scene;
    const axle = corner < 2 ? scene.front : scene.rear;
    const [cx] = place(axle.wheel);
    const cy = -this.enlarge(scene.wheel_height[corner], frame);
    setAll(rim, {cx, cy, r: scene.radius});
    const angle = this.turned[corner][frame];
    const [dx, dy] = [0.8 * scene.radius * Math.cos(angle), 0.8 * scene.radius * Math.sin(angle)];
    setAll(spoke, {x1: cx - dx, y1: cy - dy, x2: cx + dx, y2: cy + dy});
    const length = Math.hypot(axle.lower[0] - axle.upper[0], axle.lower[1] - axle.upper[1]);
    // Enlarged motion may compress the spring beyond its length.
    const ratio = Math.max(0.15, 1 - this.enlarge(scene.deflection[corner], frame) / length);
    const end = [axle.upper[0] + ratio * (axle.lower[0] - axle.upper[0]),
                 axle.upper[1] + ratio * (axle.lower[1] - axle.upper[1])];
    spring.setAttribute("points", toPoints(makeSpring(place(axle.upper), place(end))));
  }

  placeRoad(forward) {
    const shift = forward + this.view.left;
    const bump = this.scene.road.map(([x, z]) => [x - shift, this.enlarged * z]);
    this.road.setAttribute("points", toPoints([[-1, 0], ...bump.filter(([x]) => x > -1), [this.view.width + 1, 0]]
        .sort((a, b) => a[0] - b[0])));
    let path = "";  // one mark per meter
    for (let x = Math.ceil(shift); x < shift + this.view.width; ++x) path += `M${(x - shift).toFixed(3)} 0.05v0.08`;
    this.marks.setAttribute("d", path);
  }

  play() {
    if (this.frame >= this.last) this.frame = 0;
    this.button.textContent = "Pause";
    this.playing = true;
    const slow = 5;  // slow motion: the car crosses a bump in a tenth of a second
    const begin = performance.now();
    const from = this.scene.time[this.frame];
    const step = (now) => {
      if (!this.playing) return;
      const time = from + (now - begin) / 1000 / slow;
      while (this.frame < this.last && this.scene.time[this.frame] < time) ++this.frame;
      this.show(this.frame);
      this.frame < this.last ? requestAnimationFrame(step) : this.stop();
    };
    requestAnimationFrame(step);
  }

  stop() {
    this.playing = false;
    this.button.textContent = "Play";
  }
}

// Marks an instant by a line in the charts. Drawing takes longer than a frame, so only the last
// requested instant is drawn.
let wantedInstant = null;
function markInstant(time) {
  const isWaiting = wantedInstant !== null;
  wantedInstant = time;
  if (!isWaiting) requestAnimationFrame(() => {
    const at = wantedInstant;
    wantedInstant = null;
    for (const {div} of strutCharts) {
      const axes = Object.keys(div.layout).filter((key) => key.startsWith("yaxis"));
      Plotly.relayout(div, {shapes: axes.map((axis) => ({
        type: "line", x0: at, x1: at, y0: 0, y1: 1, xref: "x" + axis.slice(5), yref: "y" + axis.slice(5) + " domain",
        line: {color: readColor("--soft"), width: 1}}))});
    }
  });
}

drawAll().then(() => document.querySelectorAll("div.motion").forEach((root) => new MotionView(root)));
