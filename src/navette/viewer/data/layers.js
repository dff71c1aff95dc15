// One layer class per message type, drawn from above.
"use strict";

const plane = (pose, point) => apply(pose, point).slice(0, 2);

/** nav_msgs/OccupancyGrid as an image: unknown is transparent, higher cost is darker. */
class GridLayer {
  constructor(topic) { this.order = 0; this.isQuiet = topic !== "/map"; this.frame = ""; this.image = null; }
  read(reader) {
    this.frame = reader.header();
    reader.i32(); reader.u32();
    this.resolution = reader.f32(); this.width = reader.u32(); this.height = reader.u32();
    this.origin = readTransform(reader);
    this.cells = reader.bytes(reader.u32());
    this.image = null;
  }
  /** Bounding box of the known cells in the map's frame, or null. */
  box() {
    let [left, right, low, high] = [this.width, -1, this.height, -1];
    for (let index = 0; index < this.cells.length; index++) {
      if (this.cells[index] > 100) continue;
      const column = index % this.width, row = (index - column) / this.width;
      left = Math.min(left, column); right = Math.max(right, column);
      low = Math.min(low, row); high = row;
    }
    if (right < 0) return null;
    const [x, y] = this.origin.translation, size = this.resolution;
    return [x + left * size, y + low * size, x + (right + 1) * size, y + (high + 1) * size];
  }
  paint(ink) {
    const image = new ImageData(Math.max(1, this.width), Math.max(1, this.height));
    const free = colour(ink("free")), wall = colour(ink("wall"));
    const table = Array.from({ length: 101 }, (_, cost) => mix(free, wall, Math.sqrt(cost / 100)));
    for (let index = 0; index < this.cells.length; index++) {
      const cost = this.cells[index];
      if (cost > 100) continue; // unknown
      image.data.set(table[cost], 4 * index);
    }
    this.image = Object.assign(document.createElement("canvas"), { width: image.width, height: image.height });
    this.image.getContext("2d").putImageData(image, 0, 0);
    this.painted = ink("free");
  }
  draw(context, pose, pixel, ink, view) {
    if (!this.cells?.length) return;
    if (this.image === null || this.painted !== ink("free")) this.paint(ink);
    const { translation: [x, y], rotation } = compose(pose, this.origin);
    context.save();
    context.translate(x, y); context.rotate(yawOf(rotation));
    context.imageSmoothingEnabled = false;
    context.globalAlpha = this.isQuiet ? 0.6 : 1;
    context.drawImage(this.image, 0, 0, this.width * this.resolution, this.height * this.resolution);
    context.restore();
  }
}

/** sensor_msgs/LaserScan as points. */
class ScanLayer {
  constructor() { this.order = 2; this.frame = ""; this.points = []; }
  read(reader) {
    this.frame = reader.header();
    const [start, , step, , , nearest, farthest] = Array.from({ length: 7 }, () => reader.f32());
    this.points = [];
    for (let left = reader.u32(), angle = start; left > 0; left--, angle += step) {
      const range = reader.f32();
      if (range >= nearest && range <= farthest) this.points.push([range * Math.cos(angle), range * Math.sin(angle), 0]);
    }
  }
  draw(context, pose, pixel, ink) { dots(context, this.points.map((point) => plane(pose, point)), 1.6 * pixel, ink("laser")); }
}

/** nav_msgs/Path as a line. */
class PathLayer {
  constructor() { this.order = 3; this.frame = ""; this.points = []; }
  read(reader) {
    this.frame = reader.header();
    this.points = Array.from({ length: reader.u32() }, () => { reader.header(); return readTransform(reader).translation; });
  }
  draw(context, pose, pixel, ink) {
    context.strokeStyle = ink("thread"); context.lineWidth = 2.5 * pixel; context.lineJoin = "round";
    line(context, this.points.map((point) => plane(pose, point))); context.stroke();
  }
}

/** geometry_msgs/PoseStamped, PoseWithCovarianceStamped and PoseArray as arrows. */
class PosesLayer {
  // The marks of the robot and of the goal show these already.
  constructor(topic) { this.isQuiet = ["/amcl_pose", "/planner/goal_pose"].includes(topic); this.order = 3; this.frame = ""; this.poses = []; }
  read(reader) { this.frame = reader.header(); this.poses = this.readPoses(reader); }
  readPoses(reader) { return [readTransform(reader)]; }
  draw(context, pose, pixel, ink) {
    context.strokeStyle = ink("mark"); context.lineWidth = 2 * pixel;
    for (const each of this.poses) {
      const { translation: [x, y], rotation } = compose(pose, each), yaw = yawOf(rotation), length = 16 * pixel;
      line(context, [[x, y], [x + length * Math.cos(yaw), y + length * Math.sin(yaw)]]); context.stroke();
      dots(context, [[x, y]], 3 * pixel, ink("mark"));
    }
  }
}
class PoseArrayLayer extends PosesLayer {
  readPoses(reader) { return Array.from({ length: reader.u32() }, () => readTransform(reader)); }
}

/** geometry_msgs/PolygonStamped as an outline. */
class PolygonLayer {
  constructor(topic) { this.isQuiet = topic.endsWith("/published_footprint"); this.order = 3; this.frame = ""; this.points = []; }
  read(reader) {
    this.frame = reader.header();
    this.points = Array.from({ length: reader.u32() }, () => [reader.f32(), reader.f32(), reader.f32()]);
  }
  draw(context, pose, pixel, ink) {
    context.strokeStyle = ink("mark"); context.lineWidth = 2 * pixel;
    line(context, this.points.map((point) => plane(pose, point))); context.closePath(); context.stroke();
  }
}

/** visualization_msgs/Marker and MarkerArray: shapes as they stand on the floor. */
class MarkerLayer {
  constructor() { this.order = 1; this.frame = ""; this.markers = new Map(); }
  read(reader) { this.readOne(reader); }
  readOne(reader) {
    const frame = reader.header(), key = `${reader.text()}/${reader.i32()}`;
    const type = reader.i32(), action = reader.i32(), pose = readTransform(reader);
    const scale = [reader.f64(), reader.f64(), reader.f64()];
    const rgba = [reader.f32(), reader.f32(), reader.f32(), reader.f32()];
    reader.i32(); reader.u32(); reader.u8();
    const points = Array.from({ length: reader.u32() }, () => [reader.f64(), reader.f64(), reader.f64()]);
    for (let left = reader.u32(); left > 0; left--) for (let part = 0; part < 4; part++) reader.f32();
    reader.text();                                        // texture_resource
    reader.header(); reader.text();                       // texture: CompressedImage
    reader.bytes(reader.u32());
    for (let left = reader.u32(); left > 0; left--) { reader.f32(); reader.f32(); }
    const text = reader.text();
    reader.text(); reader.text(); reader.bytes(reader.u32()); reader.u8();
    this.frame = frame;
    if (action === 3) this.markers.clear();
    else if (action === 2) this.markers.delete(key);
    else this.markers.set(key, { frame, type, pose, scale, rgba, points, text });
  }
  draw(context, _, pixel, ink, view) {
    for (const marker of this.markers.values()) {
      const above = frames.lookUp(view.fixed, marker.frame);
      if (above !== null) drawMarker(context, marker, compose(above, marker.pose), pixel, ink);
    }
  }
}
class MarkerArrayLayer extends MarkerLayer {
  read(reader) { for (let left = reader.u32(); left > 0; left--) this.readOne(reader); }
}
const ARROW = 0, CUBE = 1, SPHERE = 2, CYLINDER = 3, LINE_STRIP = 4, LINE_LIST = 5, CUBE_LIST = 6, POINTS = 8, TEXT = 9;

function drawMarker(context, { type, scale, rgba, points, text }, pose, pixel, ink) {
  const colour = `rgb(${rgba.slice(0, 3).map((part) => Math.round(255 * part)).join(" ")} / ${rgba[3]})`;
  const [x, y] = pose.translation;
  context.save();
  context.fillStyle = context.strokeStyle = colour;
  if (type === LINE_STRIP || type === LINE_LIST) {
    context.lineWidth = Math.max(scale[0], 1.5 * pixel);
    const ends = points.map((point) => plane(pose, point));
    const parts = type === LINE_STRIP ? [ends] : ends.flatMap((end, i) => i % 2 ? [[ends[i - 1], end]] : []);
    for (const part of parts) { line(context, part); context.stroke(); }
  } else if (type >= CUBE_LIST && type <= POINTS) {
    dots(context, points.map((point) => plane(pose, point)), Math.max(scale[0] / 2, pixel), colour);
  } else if (type === TEXT) {
    context.translate(x, y); context.scale(pixel, -pixel);
    context.font = "12px system-ui, sans-serif"; context.textAlign = "center";
    context.fillText(text.slice(0, 200), 0, 0);
  } else {
    context.translate(x, y); context.rotate(yawOf(pose.rotation)); context.beginPath();
    if (type === ARROW) { context.lineWidth = Math.max(scale[1], 2 * pixel); context.moveTo(0, 0); context.lineTo(scale[0], 0); context.stroke(); }
    else if (type === CUBE) context.rect(-scale[0] / 2, -scale[1] / 2, scale[0], scale[1]);
    else if (type === SPHERE || type === CYLINDER) context.ellipse(0, 0, scale[0] / 2, scale[1] / 2, 0, 0, 7);
    context.fill();
  }
  context.restore();
}

function dots(context, points, radius, colour) {
  context.fillStyle = colour;
  for (const [x, y] of points) context.fillRect(x - radius, y - radius, 2 * radius, 2 * radius);
}
/** "#rrggbb" → [r, g, b, 255]. */
const colour = (text) => [1, 3, 5].map((at) => parseInt(text.slice(at, at + 2), 16)).concat(255);
const mix = (a, b, share) => a.map((value, index) => Math.round(value + (b[index] - value) * share));

const LAYERS = {
  "nav_msgs/msg/OccupancyGrid": GridLayer,
  "sensor_msgs/msg/LaserScan": ScanLayer,
  "nav_msgs/msg/Path": PathLayer,
  "geometry_msgs/msg/PoseStamped": PosesLayer,
  "geometry_msgs/msg/PoseWithCovarianceStamped": PosesLayer,
  "geometry_msgs/msg/PoseArray": PoseArrayLayer,
  "geometry_msgs/msg/PolygonStamped": PolygonLayer,
  "visualization_msgs/msg/Marker": MarkerLayer,
  "visualization_msgs/msg/MarkerArray": MarkerArrayLayer,
};
