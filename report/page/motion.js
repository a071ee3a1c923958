// Animation of a car on its road: a side view that moves with the car, its rear axle from behind, and
// a slider over time. make_motion() (jobs/simulate/motion.h) writes the scene; x forward, y to the
// left, z up, in meters.
"use strict";

const svgSpace = "http://www.w3.org/2000/svg";
const viewHeight = 2.4;      // m
const margin = 1.6;          // m ahead of the front and behind the rear wheels
const coils = 7;
const dashes = "0.04 0.03";  // line style of the far (left) side
const dots = "0.01 0.03";    // of another run
const rimPoints = 72;        // of a tire

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

// The same from behind: y to the left, z from the reference point.
function makeRearOutline(scene) {
  const half = scene.rear.half_track + 0.1;
  const shape = [[-half, 0.35], [-half, 0.9], [-0.8 * half, 0.98], [-0.62 * half, 1.42], [-0.4 * half, 1.46]];
  const other = shape.map(([y, z]) => [-y, z]).reverse();
  return [...shape, ...other].map(([y, z]) => [y, z - scene.nominal_height]);
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

// The first index of an ascending list whose value is at least `wanted`; its length if there is none.
function findFirst(count, get, wanted) {
  let [low, high] = [0, count];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (get(middle) < wanted) low = middle + 1; else high = middle;
  }
  return low;
}

// Height of a track's road at world x; level outside of its points.
function getHeight(track, x) {
  const i = findFirst(track.length, (k) => track[k][0], x);
  if (i === 0 || i === track.length) return 0;
  const [[x0, z0], [x1, z1]] = [track[i - 1], track[i]];
  return z0 + (z1 - z0) * (x - x0) / (x1 - x0);
}

// A scene of an earlier version has one road with its side, no roll and no track.
function completeScene(scene) {
  if (scene.road_side !== undefined) {
    scene.road = ["right", "left"].map((other) => scene.road_side === other ? [] : scene.road);
  }
  scene.roll ??= scene.time.map(() => 0);
  return scene;
}

class MotionView {
  constructor(root) {
    this.scene = completeScene(JSON.parse(root.querySelector("script").textContent));
    this.last = this.scene.time.length - 1;
    this.turned = this.scene.wheel_speed.map((speed) => integrate(this.scene.time, speed));
    this.outline = makeOutline(this.scene);
    this.enlarged = 1;
    this.slowness = 5;
    this.makePicture(root);
    this.hasRear = this.scene.rear.half_track !== undefined;
    if (this.hasRear) this.makeRearView(root);
    this.makeControls(root);
    const at = this.scene.snapshot_time;
    this.show(at === null ? 0 : this.findFrame(at));
    for (const {div} of strutCharts) {
      div.on("plotly_click", (event) => { this.stop(); this.show(this.findFrame(event.points[0].x)); });
    }
    root.dataset.motion = "drawn";
  }

  findFrame(time) {
    return Math.min(findFirst(this.last + 1, (i) => this.scene.time[i], time), this.last);
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
    const [leftTrack, rightTrack] = this.scene.road;
    const areEqual = JSON.stringify(leftTrack) === JSON.stringify(rightTrack);
    this.farRoad = areEqual ? null : addShape(this.svg, "polyline", {...ground, "stroke-dasharray": dashes});
    this.road = addShape(this.svg, "polyline", ground);
    this.marks = addShape(this.svg, "path", {...line, stroke: "var(--soft)"});
    this.body = addShape(this.svg, "polygon", {...line, fill: "var(--accent)", "fill-opacity": 0.15});
    this.reference = addShape(this.svg, "circle", {r: 0.03, fill: "var(--ink)"});
    // Front left, front right, rear left, rear right. The view is from the car's right, so the left
    // wheels are on the far side.
    const far = {"stroke-dasharray": dashes, opacity: 0.5};
    this.wheels = [0, 1, 2, 3].map((corner) => {
      const look = corner % 2 === 0 ? far : {};
      return {rim: addShape(this.svg, "polygon", {...line, class: "rim", "stroke-width": 0.03, ...look}),
              spoke: addShape(this.svg, "line", {...line, ...look}),
              spring: addShape(this.svg, "polyline", {...line, stroke: "var(--accent)", ...look})};
    });
    if (!this.scene.other) return;
    const dotted = {...line, stroke: "var(--other)", "stroke-width": 0.02, "stroke-dasharray": dots, "stroke-linecap": "round"};
    this.otherBody = addShape(this.svg, "polygon", dotted);
    this.otherWheels = [1, 3].map(() => addShape(this.svg, "circle", {...dotted, r: this.scene.radius}));
  }

  makeRearView(root) {
    this.rearOutline = makeRearOutline(this.scene);
    const half = this.scene.rear.half_track + 0.5;
    this.rearSvg = addShape(root, "svg", {viewBox: `${-half} ${-1.75} ${2 * half} ${2.0}`, class: "rear",
                                          role: "img", "aria-label": "the rear axle from behind"});
    const line = {fill: "none", stroke: "var(--ink)", "stroke-width": 0.012, "stroke-linejoin": "round"};
    this.rearGround = [0, 1].map(() => addShape(this.rearSvg, "line", {...line, stroke: "var(--soft)", "stroke-width": 0.02}));
    this.rearBody = addShape(this.rearSvg, "polygon", {...line, fill: "var(--accent)", "fill-opacity": 0.15});
    this.rearWheels = [0, 1].map(() => addShape(this.rearSvg, "rect", {...line, "stroke-width": 0.03, rx: 0.05, width: 0.2}));
    this.rearStruts = [0, 1].map(() => addShape(this.rearSvg, "line", {...line, stroke: "var(--accent)"}));
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
    this.scale = this.makeChoice("how much the motion is enlarged", [1, 3, 10].map((times) => [`motion x ${times}`, times]),
                                 (times) => { this.enlarged = times; this.show(this.frame); });
    // A car crosses a bump in a tenth of a second.
    this.speed = this.makeChoice("speed of playback", [["1/20 speed", 20], ["1/5 speed", 5], ["real time", 1]],
                                 (slowness) => { this.slowness = slowness; if (this.playing) this.play(); });
    this.speed.value = this.slowness;
    bar.append(this.button, this.slider, this.output, this.speed, this.scale);
    root.append(bar);
    this.stop();
  }

  makeChoice(label, options, use) {
    const choice = document.createElement("select");
    choice.setAttribute("aria-label", label);
    for (const [text, value] of options) choice.append(new Option(text, value));
    choice.addEventListener("change", () => use(Number(choice.value)));
    return choice;
  }

  // Enlarges the deviation from the first instant.
  enlarge(values, frame) { return values[0] + this.enlarged * (values[frame] - values[0]); }

  getRoad(side, x) { return this.enlarged * getHeight(this.scene.road[side], x); }

  show(frame) {
    const scene = this.scene;
    this.frame = frame;
    const x = scene.forward[frame];
    const z = this.enlarge(scene.height, frame);
    const place = this.makePlace(z, this.enlarge(scene.pitch, frame));
    this.body.setAttribute("points", toPoints(this.outline.map(place)));
    const [cx, cz] = place([0, 0]);
    setAll(this.reference, {cx, cy: -cz});
    this.wheels.forEach((wheel, corner) => this.placeWheel(wheel, corner, place, frame));
    this.placeRoad(x);
    if (this.hasRear) this.placeRear(frame, z);
    if (scene.other) this.placeOther(frame);
    this.slider.value = frame;
    this.output.textContent = `${scene.time[frame].toFixed(3)} s, ${x.toFixed(2)} m`;
    markInstant(scene.time[frame]);
  }

  // Maps a point of the body into the view. Positive pitch is nose down, so points ahead move down.
  makePlace(z, pitch) {
    const [cos, sin] = [Math.cos(pitch), Math.sin(pitch)];
    return ([px, pz]) => [px * cos + pz * sin - this.view.left, z - px * sin + pz * cos];
  }

  placeWheel({rim, spoke, spring}, corner, place, frame) {
    const scene = this.scene;
    const axle = corner < 2 ? scene.front : scene.rear;
    const [cx] = place(axle.wheel);
    const cz = this.enlarge(scene.wheel_height[corner], frame);
    // The tire is flat where it stands on the road.
    const shift = scene.forward[frame] + this.view.left;
    const points = [];
    for (let i = 0; i < rimPoints; ++i) {
      const angle = 2 * Math.PI * i / rimPoints;
      const x = cx + scene.radius * Math.cos(angle);
      points.push([x, Math.max(cz + scene.radius * Math.sin(angle), this.getRoad(corner % 2, x + shift))]);
    }
    rim.setAttribute("points", toPoints(points));
    const angle = this.turned[corner][frame];
    const [dx, dz] = [0.8 * scene.radius * Math.cos(angle), 0.8 * scene.radius * Math.sin(angle)];
    setAll(spoke, {x1: cx - dx, y1: -cz - dz, x2: cx + dx, y2: -cz + dz});
    const length = Math.hypot(axle.lower[0] - axle.upper[0], axle.lower[1] - axle.upper[1]);
    // Enlarged motion may compress the spring beyond its length.
    const ratio = Math.max(0.15, 1 - this.enlarge(scene.deflection[corner], frame) / length);
    const end = [axle.upper[0] + ratio * (axle.lower[0] - axle.upper[0]),
                 axle.upper[1] + ratio * (axle.lower[1] - axle.upper[1])];
    spring.setAttribute("points", toPoints(makeSpring(place(axle.upper), place(end))));
  }

  placeRoad(forward) {
    const shift = forward + this.view.left;
    this.placeTrack(this.road, 1, shift);
    if (this.farRoad) this.placeTrack(this.farRoad, 0, shift);
    let path = "";  // one mark per meter
    for (let x = Math.ceil(shift); x < shift + this.view.width; ++x) path += `M${(x - shift).toFixed(3)} 0.05v0.08`;
    this.marks.setAttribute("d", path);
  }

  placeTrack(shape, side, shift) {
    const track = this.scene.road[side];
    const end = this.view.width + 1;
    const points = [[-1, this.getRoad(side, shift - 1)]];
    for (let i = findFirst(track.length, (k) => track[k][0], shift - 1); i < track.length; ++i) {
      const x = track[i][0] - shift;
      if (x > end) break;
      points.push([x, this.enlarged * track[i][1]]);
    }
    points.push([end, this.getRoad(side, shift + end)]);
    shape.setAttribute("points", toPoints(points));
  }

  // From behind: left on the left. Positive roll is left side up.
  placeRear(frame, z) {
    const scene = this.scene;
    const roll = this.enlarge(scene.roll, frame);
    const [cos, sin] = [Math.cos(roll), Math.sin(roll)];
    // The reference point is between the axles: the body above the rear one moves by the pitch, too.
    const height = z - scene.rear.wheel[0] * Math.sin(this.enlarge(scene.pitch, frame));
    const place = ([y, pz]) => [-(y * cos - pz * sin), height + y * sin + pz * cos];
    this.rearBody.setAttribute("points", toPoints(this.rearOutline.map(place)));
    const x = scene.forward[frame] + scene.rear.wheel[0];
    const half = scene.rear.half_track;
    [2, 3].forEach((corner, side) => {
      const y = side === 0 ? half : -half;
      const center = this.enlarge(scene.wheel_height[corner], frame);
      const ground = this.getRoad(side, x);
      const bottom = Math.max(center - scene.radius, ground);
      setAll(this.rearWheels[side], {x: -y - 0.1, y: -(center + scene.radius), height: Math.max(0.01, center + scene.radius - bottom)});
      const [sx, sz] = place([y * 0.75, scene.rear.upper[1]]);
      setAll(this.rearStruts[side], {x1: sx, y1: -sz, x2: -y * 0.85, y2: -center});
      setAll(this.rearGround[side], {x1: side === 0 ? -half - 0.5 : 0, x2: side === 0 ? 0 : half + 0.5, y1: -ground, y2: -ground});
    });
  }

  // Another run at the same time, as far as its file has channels.
  placeOther(frame) {
    const {other, front, rear} = this.scene;
    const read = (values) => {
      const first = values?.find((value) => value !== null);  // it may begin later
      return (values?.[frame] ?? null) === null ? null : first + this.enlarged * (values[frame] - first);
    };
    const z = read(other.height);
    this.otherBody.style.display = z === null ? "none" : "";
    const ahead = other.forward && other.forward[frame] !== null ? other.forward[frame] - this.scene.forward[frame] : 0;
    const place = this.makePlace(z ?? 0, read(other.pitch) ?? 0);
    if (z !== null) this.otherBody.setAttribute("points", toPoints(this.outline.map(place).map(([x, pz]) => [x + ahead, pz])));
    [1, 3].forEach((corner, i) => {
      const center = read(other.wheel_height[corner]);
      this.otherWheels[i].style.display = center === null ? "none" : "";
      const [cx] = place((corner < 2 ? front : rear).wheel);
      if (center !== null) setAll(this.otherWheels[i], {cx: cx + ahead, cy: -center});
    });
  }

  play() {
    if (this.frame >= this.last) this.frame = 0;
    this.button.textContent = "Pause";
    const run = this.playing = {};  // an earlier one ends
    const begin = performance.now();
    const from = this.scene.time[this.frame];
    const step = (now) => {
      if (this.playing !== run) return;
      const time = from + (now - begin) / 1000 / this.slowness;
      while (this.frame < this.last && this.scene.time[this.frame] < time) ++this.frame;
      this.show(this.frame);
      this.frame < this.last ? requestAnimationFrame(step) : this.stop();
    };
    requestAnimationFrame(step);
  }

  stop() {
    this.playing = null;
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
