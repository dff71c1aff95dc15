/**
 * Points drawn by a loop, for machines without a graphics card: software WebGL sets up a point in
 * 1 to 2 µs, a write into an array takes some nanoseconds.
 *
 * A pixel is one word: its distance from the camera in the high half, its colour (5, 6 and 5 bits) in
 * the low half, so that the nearest point has the least word.
 */

import { rgba, type Points } from "./primitives";

export const NOTHING = 0xffffffff;
/** Bits of a 32-bit float that are cut: 1/4096 of a distance remains, and 16 bits hold 16 octaves. */
export const CUT_BITS = 11;

/** Column-major clip_T_point, as of WebGL; its fourth row gives the distance along the line of sight. */
export type Matrix = ArrayLike<number>;

const float = new Float32Array(1);
const bits = new Uint32Array(float.buffer);

export class PointRaster {
  words = new Uint32Array(0);
  /** Whether a point was drawn since `begin`. */
  hasPoints = false;
  /** Bits of the least distance. */
  baseBits = 0;
  #width = 0;
  #height = 0;

  /** Clear; `nearM` is the least distance, and points beyond 2^16 times it are not drawn. */
  begin(width: number, height: number, nearM: number): void {
    if (this.#width !== width || this.#height !== height) {
      [this.#width, this.#height] = [width, height];
      this.words = new Uint32Array(width * height);
      this.hasPoints = true;
    }
    if (this.hasPoints) this.words.fill(NOTHING);
    this.hasPoints = false;
    this.baseBits = bitsOf(nearM);
  }

  /** Draw squares of some pixels at points; row 0 is the lowest, as of textures. */
  draw({ positions, colours, colour }: Points, clip_T_point: Matrix, sizePx: number): void {
    const { words, baseBits } = this;
    const [width, height] = [this.#width, this.#height];
    const m = Float64Array.from(clip_T_point);
    const [m0, m1, m3, m4] = [m[0]!, m[1]!, m[3]!, m[4]!];
    const [m5, m7, m8, m9] = [m[5]!, m[7]!, m[8]!, m[9]!];
    const [m11, m12, m13, m15] = [m[11]!, m[12]!, m[13]!, m[15]!];
    const [red, green, blue] = rgba(colour);
    const plain = packed(red, green, blue);
    const size = Math.max(1, Math.round(sizePx));
    const [halfWidth, halfHeight, half] = [width / 2, height / 2, (size - 1) / 2];
    const count = positions.length;
    for (let at = 0; at < count; at += 3) {
      const x = positions[at]!;
      const y = positions[at + 1]!;
      const z = positions[at + 2]!;
      const w = m3 * x + m7 * y + m11 * z + m15;
      float[0] = w;
      const far = bits[0]! - baseBits;
      if (!(w > 0) || far < 0) continue; // behind the camera, or nearer than it shows
      const depth = far >>> CUT_BITS;
      if (depth > 0xfffe) continue;
      const left = Math.round(halfWidth + (halfWidth * (m0 * x + m4 * y + m8 * z + m12)) / w - 0.5 - half);
      const low = Math.round(halfHeight + (halfHeight * (m1 * x + m5 * y + m9 * z + m13)) / w - 0.5 - half);
      if (left <= -size || low <= -size || left >= width || low >= height) continue;
      const word = ((depth << 16) | (colours ? packed(colours[at]!, colours[at + 1]!, colours[at + 2]!) : plain)) >>> 0;
      const right = Math.min(width, left + size);
      const high = Math.min(height, low + size);
      for (let row = Math.max(0, low); row < high; row++) {
        const end = row * width + right;
        for (let index = row * width + Math.max(0, left); index < end; index++) if (word < words[index]!) words[index] = word;
      }
    }
    this.hasPoints ||= count > 0;
  }
}

function bitsOf(value: number): number {
  float[0] = value;
  return bits[0]!;
}

function packed(red: number, green: number, blue: number): number {
  return ((red >> 3) << 11) | ((green >> 2) << 5) | (blue >> 3);
}
