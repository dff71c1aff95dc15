/** Measured points: sensor_msgs LaserScan, PointCloud2 and Range. */

import { Display } from "../display";
import type { LaserScan, PointCloud2, Range } from "../messages";
import { faded, rgba, type Part } from "../primitives";

export class ScanDisplay extends Display<LaserScan> {
  #count = 0;

  protected override build(): Part[] {
    const scan = this.message;
    if (!scan) return [];
    const { ranges, angle_min, angle_increment, range_min, range_max } = scan;
    const positions = new Float32Array(3 * ranges.length);
    let count = 0;
    for (let index = 0; index < ranges.length; index++) {
      const range = ranges[index]!;
      if (!(range >= range_min && range <= range_max)) continue;
      const angle = angle_min + index * angle_increment;
      positions[3 * count] = range * Math.cos(angle);
      positions[3 * count + 1] = range * Math.sin(angle);
      count++;
    }
    this.#count = count;
    const points = { kind: "points", positions: positions.subarray(0, 3 * count), colour: this.colour, sizePx: this.size } as const;
    return [{
      frame: scan.header.frame_id,
      primitives: count > 0 ? [points] : [],
      about: (_, { point: [x, y] }) => [
        ["range", `${Math.hypot(x, y).toFixed(3)} m`],
        ["bearing", `${((Math.atan2(y, x) * 180) / Math.PI).toFixed(1)}°`],
      ],
    }];
  }

  protected override detail(): string {
    return `${this.#count} of ${this.message?.ranges.length ?? 0} rays hit`;
  }
}

/** Low to high; readable on a light and on a dark ground. */
const HEIGHTS = ["#3b5bdb", "#1098ad", "#37b24d", "#f59f00", "#e03131"].map(rgba);
const MOST_POINTS = 300_000;

const READERS: Record<number, [number, (view: DataView, at: number, isLittle: boolean) => number]> = {
  1: [1, (view, at) => view.getInt8(at)],
  2: [1, (view, at) => view.getUint8(at)],
  3: [2, (view, at, isLittle) => view.getInt16(at, isLittle)],
  4: [2, (view, at, isLittle) => view.getUint16(at, isLittle)],
  5: [4, (view, at, isLittle) => view.getInt32(at, isLittle)],
  6: [4, (view, at, isLittle) => view.getUint32(at, isLittle)],
  7: [4, (view, at, isLittle) => view.getFloat32(at, isLittle)],
  8: [8, (view, at, isLittle) => view.getFloat64(at, isLittle)],
};

export class CloudDisplay extends Display<PointCloud2> {
  #count = 0;
  #box: readonly [number, number, number, number] | null = null;
  #why = "";

  protected override build(): Part[] {
    this.#count = 0;
    this.#box = null;
    this.#why = "";
    const cloud = this.message;
    if (!cloud) return [];
    const { positions, shades, why } = readCloud(cloud, this.choice);
    this.#count = positions.length / 3;
    this.#why = why;
    if (this.#count === 0) return [{ frame: cloud.header.frame_id, primitives: [] }];
    this.#box = boxOf(positions);
    const colours = this.choice === "flat" ? {} : { colours: ramp(shades) };
    return [{
      frame: cloud.header.frame_id,
      primitives: [{ kind: "points", positions, ...colours, colour: this.colour, sizePx: this.size }],
      about: (_, { point: [x, y, z] }) => [["point", `${x.toFixed(2)}, ${y.toFixed(2)}, ${z.toFixed(2)} m`]],
    }];
  }

  override bounds(): readonly [number, number, number, number] | null {
    return this.#box;
  }

  protected override detail(): string {
    return this.#why || `${this.#count.toLocaleString("en")} points`;
  }
}

interface ReadCloud {
  readonly positions: Float32Array;
  /** What the points are coloured by. */
  readonly shades: Float32Array;
  /** Why there are no points. */
  readonly why: string;
}

/** Finite points of a cloud, thinned to a number that can be drawn. */
export function readCloud(cloud: PointCloud2, colourBy: string): ReadCloud {
  const { width, height, data, point_step: step } = cloud;
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  const isLittle = !cloud.is_bigendian;
  const reader = (name: string): ((at: number) => number) | null => {
    const field = cloud.fields.find((each) => each.name === name);
    const [size, read] = READERS[field?.datatype ?? 0] ?? [0, null];
    if (!field || !read || field.offset + size > step) return null;
    return (at) => read(view, at + field.offset, isLittle);
  };
  const [x, y, z] = [reader("x"), reader("y"), reader("z")];
  const empty = new Float32Array(0);
  if (!x || !y || step === 0) return { positions: empty, shades: empty, why: "the cloud has no fields x and y" };
  const shade = (colourBy === "height" ? z : reader("intensity")) ?? z ?? ((): number => 0);
  const row = height > 1 ? Math.max(cloud.row_step, width * step) : width * step;
  const stride = Math.max(1, Math.ceil((width * height) / MOST_POINTS));
  const most = Math.ceil(Math.min(width * height, Math.floor(data.length / step)) / stride);
  const positions = new Float32Array(3 * most);
  const shades = new Float32Array(most);
  let count = 0;
  for (let index = 0; index < width * height && count < most; index += stride) {
    const at = Math.floor(index / width) * row + (index % width) * step;
    if (at + step > data.length) break;
    const [px, py, pz] = [x(at), y(at), z ? z(at) : 0];
    if (!Number.isFinite(px + py + pz)) continue;
    positions[3 * count] = px;
    positions[3 * count + 1] = py;
    positions[3 * count + 2] = pz;
    shades[count++] = shade(at);
  }
  return { positions: positions.subarray(0, 3 * count), shades: shades.subarray(0, count), why: "" };
}

function ramp(shades: Float32Array): Uint8Array {
  const [low, high] = spread(shades, 1, 0);
  const table = new Uint8Array(3 * 256);
  for (let index = 0; index < 256; index++) {
    const at = (index / 255) * (HEIGHTS.length - 1);
    const below = Math.min(HEIGHTS.length - 2, Math.floor(at));
    for (let part = 0; part < 3; part++) {
      const [a, b] = [HEIGHTS[below]![part]!, HEIGHTS[below + 1]![part]!];
      table[3 * index + part] = a + (b - a) * (at - below);
    }
  }
  const colours = new Uint8Array(3 * shades.length);
  for (let index = 0; index < shades.length; index++) {
    const share = Math.max(0, Math.min(255, Math.round((255 * (shades[index]! - low)) / (high - low)) || 0));
    colours[3 * index] = table[3 * share]!;
    colours[3 * index + 1] = table[3 * share + 1]!;
    colours[3 * index + 2] = table[3 * share + 2]!;
  }
  return colours;
}

/** 2nd and 98th percentile of every `step`-th number. */
function spread(values: Float32Array, step: number, offset: number): [number, number] {
  const stride = step * Math.max(1, Math.floor(values.length / (2000 * step)));
  const some: number[] = [];
  for (let at = offset; at < values.length; at += stride) some.push(values[at]!);
  some.sort((a, b) => a - b);
  const low = some[Math.floor(0.02 * some.length)] ?? 0;
  const high = some[Math.floor(0.98 * some.length)] ?? 1;
  return high - low < 0.1 ? [low - 0.05, low + 0.05] : [low, high];
}

function boxOf(positions: Float32Array): readonly [number, number, number, number] {
  const [left, right] = spread(positions, 3, 0);
  const [low, high] = spread(positions, 3, 1);
  return [left, low, right, high];
}

/** A cone from the sensor to what it measured, in the plane. */
export class RangeDisplay extends Display<Range> {
  protected override build(): Part[] {
    const value = this.message;
    if (!value) return [];
    const hits = value.range >= value.min_range && value.range <= value.max_range;
    const reach = hits ? value.range : value.max_range;
    if (!Number.isFinite(reach)) return [{ frame: value.header.frame_id, primitives: [] }];
    const rays = 12;
    const positions = new Float32Array(3 * (rays + 2));
    for (let ray = 0; ray <= rays; ray++) {
      const angle = (ray / rays - 0.5) * value.field_of_view;
      positions[3 * ray + 3] = reach * Math.cos(angle);
      positions[3 * ray + 4] = reach * Math.sin(angle);
    }
    const fill = faded(this.colour, hits ? 0.3 : 0.08);
    return [{
      frame: value.header.frame_id,
      primitives: [{ kind: "lines", positions, mode: "loop", colour: faded(this.colour, hits ? 1 : 0.4), widthPx: this.size, fill }],
      about: () => [["range", hits ? `${value.range.toFixed(3)} m` : "nothing in range"]],
    }];
  }

  protected override detail(): string {
    const value = this.message;
    return value && value.range <= value.max_range ? `${value.range.toFixed(2)} m` : "nothing in range";
  }
}
