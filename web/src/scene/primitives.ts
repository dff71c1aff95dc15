/**
 * What displays draw with. A display makes primitives once per message; the canvas and the 3D
 * renderer both draw them and keep what they derive (images, buffers) as long as the object lives.
 */

import type { Transform, Vector } from "../transforms/transform";
import type { TransformTree } from "../transforms/transform_tree";
import type { Placement } from "./placement";

/** A CSS colour: `#rrggbb`, `#rrggbbaa` or `rgb(…)`. */
export type Colour = string;

/** A part of an image: first column and row, and how many. */
export interface Patch {
  readonly x: number;
  readonly y: number;
  readonly width: number;
  readonly height: number;
}

/** An image on a plane; its lower left corner is the origin of `pose`. */
export interface Raster {
  readonly kind: "raster";
  readonly pose: Transform;
  readonly widthM: number;
  readonly heightM: number;
  readonly columns: number;
  readonly rows: number;
  /** RGBA, row 0 at the origin. */
  readonly pixels: Uint8ClampedArray<ArrayBuffer>;
  /** Where the pixels have changed since the raster was made: grows. */
  readonly changes: readonly Patch[];
}

export interface Points {
  readonly kind: "points";
  /** x, y, z of each. */
  readonly positions: Float32Array;
  /** Red, green, blue of each; all `colour` without it. */
  readonly colours?: Uint8Array;
  readonly colour: Colour;
  readonly sizePx: number;
}

export interface Lines {
  readonly kind: "lines";
  readonly positions: Float32Array;
  /** One line through all, a closed one, or a segment for each pair. */
  readonly mode: "strip" | "loop" | "segments";
  readonly colour: Colour;
  readonly widthPx: number;
  /** Filled with this colour (strips and loops, in their plane). */
  readonly fill?: Colour;
  readonly isDashed?: boolean;
}

/** A body: box of `size`, sphere or cylinder (along z) of its diameters, or a mesh scaled by it. */
export interface Solid {
  readonly kind: "solid";
  readonly shape: "box" | "sphere" | "cylinder" | "mesh";
  readonly pose: Transform;
  readonly size: Vector;
  readonly colour: Colour;
  readonly mesh?: Mesh;
}

/** Triangles: nine numbers each. */
export interface Mesh {
  readonly positions: Float32Array;
}

/** A sign of constant size on the screen. */
export interface Sign {
  readonly kind: "sign";
  readonly shape: "dot" | "ring" | "goal" | "cross" | "arrow";
  readonly pose: Transform;
  readonly sizePx: number;
  readonly colour: Colour;
}

export interface Label {
  readonly kind: "label";
  readonly position: Vector;
  readonly text: string;
  readonly colour: Colour;
  readonly sizePx: number;
  /** How far above its place the text begins, beside a sign; 6 without it. */
  readonly abovePx?: number;
}

export type Primitive = Raster | Points | Lines | Solid | Sign | Label;

/** Primitives in a frame. `about` describes one of them when it is picked. */
export interface Part {
  readonly frame: string;
  readonly primitives: readonly Primitive[];
  /** Where the frame was when the data was taken; where it is now without it. */
  readonly placement?: Placement;
  /** Facts on a picked primitive: name, value. */
  about?(primitive: Primitive, hit: Hit): readonly (readonly [string, string])[];
}

/** fixed_T_part; null while the frames do not connect. */
export function placeOf({ frame, placement }: Part, fixed: string, transforms: TransformTree): Transform | null {
  return placement ? placement.in(fixed) : transforms.lookUp(fixed, frame);
}

/** Where a primitive was hit. */
export interface Hit {
  /** In the frame of the part. */
  readonly point: Vector;
  /** Of the point, cell or line. */
  readonly index: number;
}

/** "#rrggbb" or "rgb(1 2 3 / 0.5)" as numbers from 0 to 255, and opacity from 0 to 1. */
export function rgba(colour: Colour): [number, number, number, number] {
  const known = cache.get(colour);
  if (known) return known;
  const parsed = parse(colour);
  cache.set(colour, parsed);
  if (cache.size > 2000) cache.clear();
  return parsed;
}

const cache = new Map<string, [number, number, number, number]>();

function parse(colour: Colour): [number, number, number, number] {
  if (colour.startsWith("#")) {
    const hex = colour.length < 6 ? colour.slice(1).replace(/./g, "$&$&") : colour.slice(1);
    const at = (index: number): number => parseInt(hex.slice(index, index + 2), 16);
    return [at(0), at(2), at(4), hex.length > 6 ? at(6) / 255 : 1];
  }
  const [r = 0, g = 0, b = 0, a = 1] = (colour.match(/[\d.]+/g) ?? []).map(Number);
  return [r, g, b, a];
}

/** A CSS colour of parts from 0 to 1, as messages carry. */
export function colourOf(r: number, g: number, b: number, a = 1): Colour {
  const byte = (part: number): number => Math.round(255 * Math.min(1, Math.max(0, part)));
  return `rgb(${byte(r)} ${byte(g)} ${byte(b)} / ${Math.min(1, Math.max(0, a))})`;
}

/** The colour at another opacity. */
export function faded(colour: Colour, opacity: number): Colour {
  const [r, g, b, a] = rgba(colour);
  return `rgb(${r} ${g} ${b} / ${a * opacity})`;
}
