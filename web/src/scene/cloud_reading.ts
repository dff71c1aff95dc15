/** Reads point clouds: positions, what the points are coloured by, and their bounds. */

import type { PointCloud2 } from "./messages";
import { rgba } from "./primitives";

/** Low to high; readable on a light and on a dark ground. */
const HEIGHTS = ["#3b5bdb", "#1098ad", "#37b24d", "#f59f00", "#e03131"].map(rgba);
const MOST_POINTS = 300_000;
const FLOAT32 = 7;

type ReadNumber = (view: DataView, at: number, isLittle: boolean) => number;

/** Size and reader by sensor_msgs/PointField's number of the type. */
const READERS: Record<number, readonly [size: number, read: ReadNumber]> = {
  1: [1, (view, at) => view.getInt8(at)],
  2: [1, (view, at) => view.getUint8(at)],
  3: [2, (view, at, isLittle) => view.getInt16(at, isLittle)],
  4: [2, (view, at, isLittle) => view.getUint16(at, isLittle)],
  5: [4, (view, at, isLittle) => view.getInt32(at, isLittle)],
  6: [4, (view, at, isLittle) => view.getUint32(at, isLittle)],
  [FLOAT32]: [4, (view, at, isLittle) => view.getFloat32(at, isLittle)],
  8: [8, (view, at, isLittle) => view.getFloat64(at, isLittle)],
};
const IS_LITTLE_MACHINE = new Uint8Array(Uint16Array.of(1).buffer)[0] === 1;

export interface ReadCloud {
  readonly positions: Float32Array;
  /** What the points are coloured by. */
  readonly shades: Float32Array;
  /** Why there are no points. */
  readonly why: string;
}

interface Field {
  readonly offset: number;
  readonly datatype: number;
}

/** The fields of a cloud that are read; what a cloud lacks is zero. */
interface Fields {
  readonly x: Field;
  readonly y: Field;
  readonly z: Field | null;
  readonly shade: Field | null;
}

/** Where the points are in the data: `first + stride * index`, in rows that may be padded. */
interface Grid {
  readonly count: number;
  readonly width: number;
  readonly rowBytes: number;
  /** Every so many points are read. */
  readonly stride: number;
}

/** Finite points of a cloud, thinned to a number that can be drawn. */
export function readCloud(cloud: PointCloud2, colourBy: string): ReadCloud {
  const fields = fieldsOf(cloud, colourBy);
  const empty = new Float32Array(0);
  if (!fields) return { positions: empty, shades: empty, why: "the cloud has no fields x and y" };
  const grid = gridOf(cloud);
  const numbers = floatsOf(cloud, fields, grid);
  return numbers ? readFloats(cloud, fields, grid, numbers) : readAny(cloud, fields, grid);
}

function fieldsOf(cloud: PointCloud2, colourBy: string): Fields | null {
  const field = (name: string): Field | null => {
    const found = cloud.fields.find((each) => each.name === name);
    const [size] = READERS[found?.datatype ?? 0] ?? [Infinity];
    return found && found.offset + size <= cloud.point_step ? found : null;
  };
  const [x, y, z] = [field("x"), field("y"), field("z")];
  if (!x || !y) return null;
  return { x, y, z, shade: (colourBy === "height" ? z : field("intensity")) ?? z };
}

function gridOf({ width, height, data, point_step: step, row_step: rowStep }: PointCloud2): Grid {
  const rowBytes = height > 1 ? Math.max(rowStep, width * step) : width * step;
  // Rows and points that are not there are not read.
  const whole = rowBytes > 0 ? Math.floor(data.length / rowBytes) : 0;
  const rest = Math.floor((data.length - whole * rowBytes) / step);
  const count = Math.min(width * height, whole * width + Math.min(width, rest));
  return { count, width, rowBytes, stride: Math.max(1, Math.ceil(count / MOST_POINTS)) };
}

/** The data as numbers of this machine, if every field that is read is one; else null. */
function floatsOf({ data, is_bigendian, point_step: step }: PointCloud2, { x, y, z, shade }: Fields, { rowBytes }: Grid): Float32Array | null {
  const isFloat = (field: Field | null): boolean => !field || (field.datatype === FLOAT32 && field.offset % 4 === 0);
  if (is_bigendian === IS_LITTLE_MACHINE || step % 4 > 0 || rowBytes % 4 > 0) return null;
  if (![x, y, z, shade].every(isFloat)) return null;
  const length = Math.floor(data.length / 4);
  // A message lies anywhere in its frame: numbers of four bytes need another copy there.
  return data.byteOffset % 4 === 0
    ? new Float32Array(data.buffer, data.byteOffset, length)
    : new Float32Array(data.slice(0, 4 * length).buffer);
}

/** Clouds of 32-bit numbers, which most are, without a call per number. */
function readFloats({ point_step: step }: PointCloud2, fields: Fields, { count, width, rowBytes, stride }: Grid, numbers: Float32Array): ReadCloud {
  const most = Math.ceil(count / stride);
  const positions = new Float32Array(3 * most);
  const shades = new Float32Array(most);
  const [x, y] = [fields.x.offset / 4, fields.y.offset / 4];
  const [z, shade] = [fields.z ? fields.z.offset / 4 : -1, fields.shade ? fields.shade.offset / 4 : -1];
  let read = 0;
  for (let index = 0; index < count; index += stride) {
    const row = Math.floor(index / width);
    const at = (row * rowBytes + (index - row * width) * step) / 4;
    const px = numbers[at + x]!;
    const py = numbers[at + y]!;
    const pz = z < 0 ? 0 : numbers[at + z]!;
    if (!Number.isFinite(px + py + pz)) continue;
    positions[3 * read] = px;
    positions[3 * read + 1] = py;
    positions[3 * read + 2] = pz;
    shades[read] = shade < 0 ? 0 : numbers[at + shade]!;
    read += 1;
  }
  return { positions: positions.subarray(0, 3 * read), shades: shades.subarray(0, read), why: "" };
}

/** Clouds of any types, in any order of bytes. */
function readAny(cloud: PointCloud2, fields: Fields, { count, width, rowBytes, stride }: Grid): ReadCloud {
  const { data, point_step: step } = cloud;
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  const reader = (field: Field | null): ((at: number) => number) => {
    if (!field) return () => 0;
    const [, read] = READERS[field.datatype]!;
    return (at) => read(view, at + field.offset, !cloud.is_bigendian);
  };
  const [x, y, z, shade] = [reader(fields.x), reader(fields.y), reader(fields.z), reader(fields.shade)];
  const most = Math.ceil(count / stride);
  const positions = new Float32Array(3 * most);
  const shades = new Float32Array(most);
  let read = 0;
  for (let index = 0; index < count; index += stride) {
    const at = Math.floor(index / width) * rowBytes + (index % width) * step;
    const px = x(at);
    const py = y(at);
    const pz = z(at);
    if (!Number.isFinite(px + py + pz)) continue;
    positions[3 * read] = px;
    positions[3 * read + 1] = py;
    positions[3 * read + 2] = pz;
    shades[read++] = shade(at);
  }
  return { positions: positions.subarray(0, 3 * read), shades: shades.subarray(0, read), why: "" };
}

/** Red, green, blue of each point. */
export function rampOf(shades: Float32Array): Uint8Array {
  const [low, high] = spread(shades, 1, 0);
  const table = rampTable();
  const colours = new Uint8Array(3 * shades.length);
  const factor = 255 / (high - low);
  for (let index = 0; index < shades.length; index++) {
    const from = 3 * Math.max(0, Math.min(255, (factor * (shades[index]! - low) + 0.5) | 0)); // NaN is the lowest
    colours[3 * index] = table[from]!;
    colours[3 * index + 1] = table[from + 1]!;
    colours[3 * index + 2] = table[from + 2]!;
  }
  return colours;
}

function rampTable(): Uint8Array {
  const table = new Uint8Array(3 * 256);
  for (let index = 0; index < 256; index++) {
    const at = (index / 255) * (HEIGHTS.length - 1);
    const below = Math.min(HEIGHTS.length - 2, Math.floor(at));
    for (let part = 0; part < 3; part++) {
      const [a, b] = [HEIGHTS[below]![part]!, HEIGHTS[below + 1]![part]!];
      table[3 * index + part] = a + (b - a) * (at - below);
    }
  }
  return table;
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

/** Left, low, right, high of most points. */
export function boxOf(positions: Float32Array): readonly [number, number, number, number] {
  const [left, right] = spread(positions, 3, 0);
  const [low, high] = spread(positions, 3, 1);
  return [left, low, right, high];
}
