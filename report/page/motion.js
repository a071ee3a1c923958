// Animation of a car on its road: a side view that moves with the car, its axles from the front and from
// behind, and a slider over time. make_motion() (jobs/simulate/motion.h) writes the scene; x forward, y to the
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

const makeDotted = (line) => ({...line, stroke: "var(--other)", "stroke-width": 0.02, "stroke-dasharray": dots, "stroke-linecap": "round"});

// A sedan's outline: x as a fraction of the wheelbase from the rear axle, z from the ground at rest.
function makeOutline(scene) {
  const base = scene.front.wheel[0] - scene.rear.wheel[0];
  const shape = [[-0.33, 0.35], [-0.36, 0.62], [-0.33, 0.92], [-0.1, 0.98], [0.12, 1.38], [0.3, 1.46],
                 [0.52, 1.44], [0.78, 1.02], [1.12, 0.9], [1.28, 0.72], [1.29, 0.35]];
  return shape.map(([fraction, z]) => [scene.rear.wheel[0] + fraction * base, z - scene.nominal_height]);
}

// The same along the car: y to the left, z from the reference point.
function makeCrossOutline(scene, axle) {
  const half = axle.half_track + 0.1;
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

// A scene of an earlier version has one road with its side, no roll, no track and no links.
function completeScene(scene) {
  if (scene.road_side !== undefined) {
    scene.road = ["right", "left"].map((other) => scene.road_side === other ? [] : scene.road);
  }
  scene.roll ??= scene.time.map(() => 0);
  for (const axle of [scene.front, scene.rear]) axle.links ??= [];
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
    this.axleViews = [];
    if (this.scene.rear.half_track !== undefined) this.makeAxleViews(root);
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
      const axle = corner < 2 ? this.scene.front : this.scene.rear;
      const addLine = (more) => addShape(this.svg, "line", {...line, ...look, ...more});
      return {links: axle.links.map(() => addLine({stroke: "var(--soft)", "stroke-width": 0.018})),
              damper: axle.damper && addLine({"stroke-width": 0.035, opacity: corner % 2 === 0 ? 0.3 : 0.6}),
              rim: addShape(this.svg, "polygon", {...line, class: "rim", "stroke-width": 0.03, ...look}),
              spoke: addLine({}),
              spring: addShape(this.svg, "polyline", {...line, stroke: "var(--accent)", ...look})};
    });
    if (!this.scene.other) return;
    const dotted = makeDotted(line);
    this.otherBody = addShape(this.svg, "polygon", dotted);
    this.otherWheels = [1, 3].map(() => addShape(this.svg, "circle", {...dotted, r: this.scene.radius}));
  }

  // The front axle from the front, the rear axle from behind.
  makeAxleViews(root) {
    const box = document.createElement("div");
    box.className = "axles";
    root.append(box);
    const {front, rear} = this.scene;
    this.axleViews = [this.makeAxleView(box, front, 0, 1, "the front axle from the front"),
                      this.makeAxleView(box, rear, 2, -1, "the rear axle from behind")];
  }

  // sign: of a place to the left of the car on the screen.
  makeAxleView(box, axle, firstCorner, sign, name) {
    const half = axle.half_track + 0.4;
    const svg = addShape(box, "svg", {viewBox: `${-half} -1.7 ${2 * half} 1.95`, class: "axle", role: "img", "aria-label": name});
    const line = {fill: "none", stroke: "var(--ink)", "stroke-width": 0.012, "stroke-linejoin": "round"};
    const makeSide = () => ({
      ground: addShape(svg, "line", {...line, stroke: "var(--soft)", "stroke-width": 0.02}),
      links: axle.links.map(() => addShape(svg, "line", {...line, stroke: "var(--soft)", "stroke-width": 0.018})),
      damper: axle.damper && addShape(svg, "line", {...line, "stroke-width": 0.035, opacity: 0.6}),
      spring: axle.spring_y && addShape(svg, "polyline", {...line, stroke: "var(--accent)"}),
      wheel: addShape(svg, "rect", {...line, "stroke-width": 0.03, rx: 0.05, width: 0.2})});
    const body = addShape(svg, "polygon", {...line, fill: "var(--accent)", "fill-opacity": 0.15});
    const view = {axle, firstCorner, sign, half, body, outline: makeCrossOutline(this.scene, axle), sides: [makeSide(), makeSide()]};
    if (this.scene.other) {
      const dotted = makeDotted(line);
      view.otherBody = addShape(svg, "polygon", dotted);
      view.otherWheels = [0, 1].map(() => addShape(svg, "rect", {...dotted, rx: 0.05, width: 0.2}));
    }
    return view;
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
    for (const view of this.axleViews) this.placeAxle(view, frame, z);
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

  // The end of a spring on its wheel's side: shortened by its deflection. Enlarged motion may compress it
  // beyond its length.
  calcSpringRatio(axle, corner, frame) {
    const length = Math.hypot(axle.lower[0] - axle.upper[0], axle.lower[1] - axle.upper[1]);
    return Math.max(0.15, 1 - this.enlarge(this.scene.deflection[corner], frame) / length);
  }

  // Draws links and damper. `onBody` and `onWheel` map a point from the wheel's center at nominal trim into
  // the view, as it moves with the body or with the wheel.
  placeLinks({links, damper}, axle, onBody, onWheel) {
    const join = (shape, [x1, z1], [x2, z2]) => setAll(shape, {x1, y1: -z1, x2, y2: -z2});
    axle.links.forEach(([inner, outer], i) => join(links[i], onBody(inner), onWheel(outer)));
    if (!axle.damper) return;
    const {upper, lower, share} = axle.damper;
    const [fixed, moved] = [onBody(lower), onWheel(lower)];
    join(damper, onBody(upper), fixed.map((value, i) => value + share * (moved[i] - value)));
  }

  // Maps a point (y, z) of the body into the view along an axle. Positive roll is left side up.
  makeCross(sign, height, roll) {
    const [cos, sin] = [Math.cos(roll), Math.sin(roll)];
    return ([y, pz]) => [sign * (y * cos - pz * sin), height + y * sin + pz * cos];
  }

  placeWheel(shapes, corner, place, frame) {
    const {rim, spoke, spring} = shapes;
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
    const ratio = this.calcSpringRatio(axle, corner, frame);
    const end = [axle.upper[0] + ratio * (axle.lower[0] - axle.upper[0]),
                 axle.upper[1] + ratio * (axle.lower[1] - axle.upper[1])];
    spring.setAttribute("points", toPoints(makeSpring(place(axle.upper), place(end))));
    this.placeLinks(shapes, axle, ([px, , pz]) => place([axle.wheel[0] + px, axle.wheel[1] + pz]),
                    ([px, , pz]) => [cx + px, cz + pz]);
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

  placeAxle({axle, firstCorner, sign, half, body, outline, sides}, frame, z) {
    const scene = this.scene;
    // The body above the axle also moves by the pitch.
    const height = z - axle.wheel[0] * Math.sin(this.enlarge(scene.pitch, frame));
    const place = this.makeCross(sign, height, this.enlarge(scene.roll, frame));
    body.setAttribute("points", toPoints(outline.map(place)));
    const x = scene.forward[frame] + axle.wheel[0];
    sides.forEach((shapes, side) => {
      const corner = firstCorner + side;
      const left = side === 0 ? 1 : -1;
      const center = this.enlarge(scene.wheel_height[corner], frame);
      const ground = this.getRoad(side, x);
      const bottom = Math.max(center - scene.radius, ground);
      setAll(shapes.wheel, {x: sign * left * axle.half_track - 0.1, y: -(center + scene.radius),
                            height: Math.max(0.01, center + scene.radius - bottom)});
      setAll(shapes.ground, {x1: 0, x2: sign * left * half, y1: -ground, y2: -ground});
      this.placeLinks(shapes, axle, ([, y, pz]) => place([left * y, axle.wheel[1] + pz]),
                      ([, y, pz]) => [sign * left * y, center + pz]);
      if (!shapes.spring) return;
      const ratio = this.calcSpringRatio(axle, corner, frame);
      const [[y0, y1], z0, z1] = [axle.spring_y, axle.upper[1], axle.lower[1]];
      const end = [left * (y0 + ratio * (y1 - y0)), z0 + ratio * (z1 - z0)];
      shapes.spring.setAttribute("points", toPoints(makeSpring(place([left * y0, z0]), place(end))));
    });
  }

  // A value of another run, enlarged like this one's; null where it has none. One with another origin is
  // shown relative to its own first value.
  readOther(values, own, frame) {
    const value = values?.[frame] ?? null;
    if (value === null) return null;
    const first = values.find((v) => v !== null);  // it may begin later
    const base = Math.abs(first - own[0]) < 0.1 ? own[0] : first;
    return own[0] + this.enlarged * (value - base);
  }

  // Another run at the same time, as far as its file has channels.
  placeOther(frame) {
    const {other, front, rear} = this.scene;
    const z = this.readOther(other.height, this.scene.height, frame);
    this.otherBody.style.display = z === null ? "none" : "";
    const ahead = other.forward && other.forward[frame] !== null ? other.forward[frame] - this.scene.forward[frame] : 0;
    const pitch = this.readOther(other.pitch, this.scene.pitch, frame) ?? 0;
    const place = this.makePlace(z ?? 0, pitch);
    if (z !== null) this.otherBody.setAttribute("points", toPoints(this.outline.map(place).map(([x, pz]) => [x + ahead, pz])));
    [1, 3].forEach((corner, i) => {
      const center = this.readOther(other.wheel_height[corner], this.scene.wheel_height[corner], frame);
      this.otherWheels[i].style.display = center === null ? "none" : "";
      const [cx] = place((corner < 2 ? front : rear).wheel);
      if (center !== null) setAll(this.otherWheels[i], {cx: cx + ahead, cy: -center});
    });
    for (const view of this.axleViews) this.placeOtherAxle(view, frame, z, pitch);
  }

  placeOtherAxle({axle, firstCorner, sign, outline, otherBody, otherWheels}, frame, z, pitch) {
    const {other} = this.scene;
    const place = this.makeCross(sign, z - axle.wheel[0] * Math.sin(pitch), this.readOther(other.roll, this.scene.roll, frame) ?? 0);
    otherBody.style.display = z === null ? "none" : "";
    if (z !== null) otherBody.setAttribute("points", toPoints(outline.map(place)));
    otherWheels.forEach((wheel, side) => {
      const corner = firstCorner + side;
      const center = this.readOther(other.wheel_height[corner], this.scene.wheel_height[corner], frame);
      wheel.style.display = center === null ? "none" : "";
      const y = sign * (side === 0 ? 1 : -1) * axle.half_track;
      if (center !== null) setAll(wheel, {x: y - 0.1, y: -(center + this.scene.radius), height: 2 * this.scene.radius});
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
