// sensor_msgs/PointCloud2 from above: each pixel shows its highest point, coloured by height.
"use strict";

const MAX_POINTS = 300000;
// Low to high; readable on a light and on a dark ground.
const HEIGHTS = ["#3b5bdb", "#1098ad", "#37b24d", "#f59f00", "#e03131"];
const NUMBER_TYPES = {
  1: [1, "getInt8"], 2: [1, "getUint8"], 3: [2, "getInt16"], 4: [2, "getUint16"],
  5: [4, "getInt32"], 6: [4, "getUint32"], 7: [4, "getFloat32"], 8: [8, "getFloat64"],
};

/** A function (point's first byte) → number for a field, or null if it has no such type. */
function fieldReader(view, field, littleEndian, step) {
  const [size, getter] = NUMBER_TYPES[field?.datatype] ?? [0];
  if (!size || field.offset + size > step) return null;
  return (at) => view[getter](at + field.offset, littleEndian);
}

/** 2nd and 98th percentile of x (0), y (1) or z (2). */
function range(points, axis) {
  const some = [], step = 3 * Math.max(1, Math.floor(points.length / 6000));
  for (let at = axis; at < points.length; at += step) some.push(points[at]);
  some.sort((a, b) => a - b);
  const low = some[Math.floor(0.02 * some.length)] ?? 0, high = some[Math.floor(0.98 * some.length)] ?? 1;
  return high - low < 0.1 ? [low - 0.05, low + 0.05] : [low, high];
}

class CloudLayer {
  constructor() { this.order = 2; this.frame = ""; this.xyz = new Float32Array(0); }

  read(reader) {
    this.frame = reader.header();
    const height = reader.u32(), width = reader.u32(), fields = {};
    for (let left = reader.u32(); left > 0; left--) {
      const name = reader.text(), offset = reader.u32(), datatype = reader.u8();
      reader.u32();
      fields[name] = { offset, datatype };
    }
    const littleEndian = reader.u8() === 0, step = reader.u32(), rowStep = reader.u32();
    const bytes = reader.bytes(reader.u32());
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    const [x, y, z] = ["x", "y", "z"].map((name) => fieldReader(view, fields[name], littleEndian, step));
    this.xyz = new Float32Array(0);
    if (!x || !y || step === 0) return;
    const stride = Math.max(1, Math.ceil((width * height) / MAX_POINTS));
    const row = height > 1 ? Math.max(rowStep, width * step) : width * step;
    const most = Math.min(width * height, Math.floor(bytes.length / step));
    const found = new Float32Array(3 * Math.ceil(most / stride));
    let count = 0;
    for (let index = 0; index < width * height && 3 * count < found.length; index += stride) {
      const at = Math.floor(index / width) * row + (index % width) * step;
      if (at + step > bytes.length) break;
      const px = x(at), py = y(at), pz = z ? z(at) : 0;
      if (!Number.isFinite(px + py + pz)) continue;
      found[3 * count] = px; found[3 * count + 1] = py; found[3 * count + 2] = pz;
      count++;
    }
    this.xyz = found.subarray(0, 3 * count);
  }

  /** Bounding box of most points in the fixed frame, or null. */
  box() {
    if (!this.points?.length) return null;
    const [[left, right], [low, high]] = [range(this.points, 0), range(this.points, 1)];
    return [left, low, right, high];
  }

  draw(context, pose) {
    if (!this.xyz.length) return;
    const { width, height } = context.canvas, points = this.points = this.turned(pose);
    const { a: scale, e: left, f: top } = context.getTransform();
    const picture = this.pictureOf(width, height);
    const [low, high] = range(points, 2);
    const highest = new Float32Array(width * height).fill(-Infinity);
    const pixels = new Uint32Array(picture.image.data.buffer).fill(0), table = heightTable();
    const size = Math.max(2, Math.round(1.6 * (devicePixelRatio || 1)));
    for (let at = 0; at < points.length; at += 3) {
      const column = Math.round(left + scale * points[at] - size / 2), row = Math.round(top - scale * points[at + 1] - size / 2);
      if (column < 0 || row < 0 || column + size > width || row + size > height) continue;
      const z = points[at + 2], share = (z - low) / (high - low);
      const shown = table[Math.max(0, Math.min(255, Math.round(255 * share)))];
      for (let r = row; r < row + size; r++) for (let c = column; c < column + size; c++) {
        const pixel = r * width + c;
        if (z > highest[pixel]) { highest[pixel] = z; pixels[pixel] = shown; }
      }
    }
    picture.canvas.getContext("2d").putImageData(picture.image, 0, 0);
    context.save();
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.drawImage(picture.canvas, 0, 0);
    context.restore();
  }

  /** The points in the fixed frame. */
  turned({ translation: [tx, ty, tz], rotation }) {
    const [a, b, c] = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map((axis) => rotate(rotation, axis));
    const turned = new Float32Array(this.xyz.length);
    for (let at = 0; at < turned.length; at += 3) {
      const x = this.xyz[at], y = this.xyz[at + 1], z = this.xyz[at + 2];
      turned[at] = tx + a[0] * x + b[0] * y + c[0] * z;
      turned[at + 1] = ty + a[1] * x + b[1] * y + c[1] * z;
      turned[at + 2] = tz + a[2] * x + b[2] * y + c[2] * z;
    }
    return turned;
  }

  pictureOf(width, height) {
    if (this.picture?.canvas.width !== width || this.picture.canvas.height !== height) {
      const canvas = Object.assign(document.createElement("canvas"), { width, height });
      this.picture = { canvas, image: new ImageData(width, height) };
    }
    return this.picture;
  }
}

let colours = null;
/** 256 colours as pixel values: red in the lowest byte. */
function heightTable() {
  colours ??= Uint32Array.from({ length: 256 }, (_, index) => {
    const at = (index / 255) * (HEIGHTS.length - 1), low = Math.min(HEIGHTS.length - 2, Math.floor(at));
    const [r, g, b] = mix(colour(HEIGHTS[low]), colour(HEIGHTS[low + 1]), at - low);
    return ((255 << 24) | (b << 16) | (g << 8) | r) >>> 0;
  });
  return colours;
}

LAYERS["sensor_msgs/msg/PointCloud2"] = CloudLayer;
