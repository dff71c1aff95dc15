// Top-down view: a canvas that pans, zooms and follows the robot, with a layer per topic.
"use strict";

const REST_FACTOR = 2, LONGEST_REST_MS = 250;

const view = {
  rest: 0, // ms until the next frame may begin
  canvas: null, fixed: null, dirty: false,
  centre: [0, 0], scale: 30, // pixels per metre
  follows: true,
  layers: new Map(),         // topic → layer
  trail: [],                 // past positions of the base in the fixed frame
  base: null,                // fixed_T_base
  outline: [],               // the footprint in the base frame
  goal: null,
  hidden: new Set(),         // hidden topics
  known: new Set(),          // topics that were drawn before

  start(canvas, onClick) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d");
    new ResizeObserver(() => this.invalidate()).observe(canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.invalidate());
    listenToPointer(this, onClick);
  },

  /** Draw a message; true if the view supports its type. */
  take(topic, schema, reader) {
    if (schema === "tf2_msgs/msg/TFMessage") { frames.take(reader); this.invalidate(); return true; }
    const make = LAYERS[schema];
    if (make === undefined) return false;
    const layer = this.layers.get(topic) ?? this.add(topic, new make(topic));
    layer.read(reader);
    if (topic === "/map" || this.fixed === null) this.fixed = layer.frame;
    this.invalidate();
    return true;
  },

  add(topic, layer) {
    if (layer.isQuiet && !this.known.has(topic)) this.hidden.add(topic); // the user decides afterwards
    if (topic === "/path" && !this.known.has(topic)) this.hidden.add("/plan"); // the same under Nav2's name
    this.known.add(topic);
    this.layers.set(topic, layer);
    const order = (l) => l.order;
    this.layers = new Map([...this.layers].sort(([, a], [, b]) => order(a) - order(b)));
    this.listLayers?.(this);
    return layer;
  },
  /** Remove outdated data of these topics. */
  forget(topics) {
    for (const topic of topics) this.layers.delete(topic);
    this.trail = []; this.base = null;
    this.invalidate();
  },
  remove(topic) { if (this.layers.delete(topic)) { this.listLayers?.(this); this.invalidate(); } },
  clear() {
    this.layers.clear(); this.trail = []; this.base = null; this.fixed = null; this.goal = null;
    frames.clear(); this.listLayers?.(this); this.invalidate();
  },

  /** Where the robot is: frame_T_child of the odometry. */
  moveTo(frame, child, pose) {
    const fixed = this.fixed ?? frame;
    const above = frame === fixed ? IDENTITY : frames.lookUp(fixed, frame);
    if (above === null) return;
    // The outline is about the base; the odometry may be another frame's, the lidar's.
    const roots = ["base_link", "base_footprint", "robot"];
    const root = roots.find((name) => name === child) ?? [...frames.chain(child).keys()].find((name) => roots.includes(name));
    this.base = compose(compose(above, pose), (root && frames.lookUp(child, root)) || IDENTITY);
    const [bx, by] = this.base.translation, last = this.trail.at(-1);
    if (last && Math.hypot(bx - last[0], by - last[1]) > 2) this.trail = [];
    if (!last || Math.hypot(bx - last[0], by - last[1]) > 0.05) this.trail.push([bx, by]);
    if (this.trail.length > 20000) this.trail.shift();
    this.invalidate();
  },

  invalidate() {
    if (this.dirty || !this.canvas) return;
    this.dirty = true;
    // Rest after each frame: where drawing is slow, a key must not wait behind frames.
    setTimeout(() => requestAnimationFrame((begin) => {
      this.dirty = false;
      drawView(this);
      this.rest = Math.min(REST_FACTOR * (performance.now() - begin), LONGEST_REST_MS);
    }), this.rest);
  },

  /** Pixels of the canvas → metres in the fixed frame. */
  toWorld(px, py) {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    return [this.centre[0] + (px - width / 2) / this.scale, this.centre[1] - (py - height / 2) / this.scale];
  },
  zoom(factor, px, py) {
    const before = this.toWorld(px, py);
    this.scale = Math.min(400, Math.max(2, this.scale * factor));
    const after = this.toWorld(px, py);
    if (!this.follows) this.centre = [this.centre[0] + before[0] - after[0], this.centre[1] + before[1] - after[1]];
    this.invalidate();
  },
  follow(follows) { this.follows = follows; this.onFollow?.(follows); this.invalidate(); },
  /** Everything that is known, and the goal, in the middle. */
  fit() {
    const cloud = [...this.layers.values()].find((layer) => layer instanceof CloudLayer);
    const known = this.layers.get("/map")?.box() ?? cloud?.box() ?? [-6, -6, 6, 6];
    const box = this.goal === null ? known : widened(known, this.goal);
    const { clientWidth: width, clientHeight: height } = this.canvas;
    this.follow(false);
    this.centre = [(box[0] + box[2]) / 2, (box[1] + box[3]) / 2];
    this.scale = 0.94 * Math.min(width / (box[2] - box[0]), height / (box[3] - box[1]));
    this.invalidate();
  },
};

/** A box that holds a place too, with a metre around it. */
function widened([left, low, right, high], [x, y]) {
  return [Math.min(left, x - 1), Math.min(low, y - 1), Math.max(right, x + 1), Math.max(high, y + 1)];
}

function listenToPointer(view, onClick) {
  const pointers = new Map();
  let moved = 0, spread = 0;
  const at = (event) => [event.offsetX, event.offsetY];
  view.canvas.addEventListener("pointerdown", (event) => {
    view.canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, at(event));
    moved = 0; spread = 0;
  });
  view.canvas.addEventListener("pointermove", (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    const [x, y] = at(event);
    pointers.set(event.pointerId, [x, y]);
    moved += Math.hypot(x - before[0], y - before[1]);
    if (pointers.size === 2) {
      const [a, b] = [...pointers.values()], now = Math.hypot(a[0] - b[0], a[1] - b[1]);
      if (spread) view.zoom(now / spread, (a[0] + b[0]) / 2, (a[1] + b[1]) / 2);
      spread = now;
    } else if (moved > 4) {
      view.follow(false);
      view.centre = [view.centre[0] - (x - before[0]) / view.scale, view.centre[1] + (y - before[1]) / view.scale];
      view.invalidate();
    }
  });
  const end = (event) => {
    const was = pointers.delete(event.pointerId);
    if (was && event.type === "pointerup" && moved <= 4 && pointers.size === 0) onClick(...view.toWorld(...at(event)));
  };
  view.canvas.addEventListener("pointerup", end);
  view.canvas.addEventListener("pointercancel", end);
  view.canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    view.zoom(Math.exp(-event.deltaY * 0.0015), ...at(event));
  }, { passive: false });
}

function drawView(view) {
  const { canvas, context } = view, ratio = devicePixelRatio || 1;
  const width = canvas.clientWidth, height = canvas.clientHeight;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio); canvas.height = Math.round(height * ratio);
  }
  const style = getComputedStyle(document.documentElement);
  const ink = (name) => style.getPropertyValue(`--${name}`).trim();
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.fillStyle = ink("unknown");
  context.fillRect(0, 0, canvas.width, canvas.height);
  if (view.fixed === null) return;
  if (view.follows && view.base) view.centre = view.base.translation.slice(0, 2);
  // Metres, y up.
  context.setTransform(ratio * view.scale, 0, 0, -ratio * view.scale,
    ratio * (width / 2 - view.centre[0] * view.scale), ratio * (height / 2 + view.centre[1] * view.scale));
  const pixel = 1 / view.scale;
  for (const [topic, layer] of view.layers) {
    if (view.hidden.has(topic)) continue;
    const pose = layer.frame === view.fixed ? IDENTITY : frames.lookUp(view.fixed, layer.frame);
    if (pose !== null) layer.draw(context, pose, pixel, ink, view);
  }
  drawGrid(context, view, width, height, pixel, ink);
  drawTrail(context, view.trail, pixel, ink);
  if (view.goal) drawGoalMark(context, view.goal, pixel, ink);
  if (view.base) drawRobot(context, view, pixel, ink);
}

function drawGrid(context, view, width, height, pixel, ink) {
  const step = [0.5, 1, 2, 5, 10, 20].find((metres) => metres * view.scale > 45) ?? 50;
  const [left, top] = view.toWorld(0, 0), [right, bottom] = view.toWorld(width, height);
  context.strokeStyle = ink("grid"); context.lineWidth = pixel; context.beginPath();
  for (let x = Math.ceil(left / step) * step; x < right; x += step) { context.moveTo(x, top); context.lineTo(x, bottom); }
  for (let y = Math.ceil(bottom / step) * step; y < top; y += step) { context.moveTo(left, y); context.lineTo(right, y); }
  context.stroke();
}
function line(context, points) {
  context.beginPath();
  points.forEach(([x, y], index) => index ? context.lineTo(x, y) : context.moveTo(x, y));
}
function drawTrail(context, trail, pixel, ink) {
  context.strokeStyle = ink("trail"); context.lineWidth = 2 * pixel; context.lineJoin = "round";
  line(context, trail); context.stroke();
}
function drawGoalMark(context, [x, y], pixel, ink) {
  context.strokeStyle = ink("thread"); context.lineWidth = 2.5 * pixel;
  context.beginPath(); context.arc(x, y, 8 * pixel, 0, 7); context.stroke();
  context.fillStyle = ink("thread");
  context.beginPath(); context.arc(x, y, 2.5 * pixel, 0, 7); context.fill();
}
function drawRobot(context, view, pixel, ink) {
  const [x, y] = view.base.translation;
  context.save();
  context.translate(x, y); context.rotate(yawOf(view.base.rotation));
  const small = 9 * pixel;
  const outline = view.outline.length > 2 ? view.outline : [[small, 0], [-small, small * 0.75], [-small * 0.5, 0], [-small, -small * 0.75]];
  line(context, outline); context.closePath();
  context.fillStyle = ink("body"); context.fill();
  context.strokeStyle = ink("thread"); context.lineWidth = 2 * pixel; context.stroke();
  const nose = Math.max(...outline.map(([ox]) => ox));
  context.fillStyle = ink("thread");
  line(context, [[nose * 0.8, 0], [nose * 0.3, nose * 0.22], [nose * 0.3, -nose * 0.22]]);
  context.closePath(); context.fill();
  context.restore();
}
