/** What the scene gives to a renderer. */

import type { Transform } from "../transforms/transform";
import type { Part } from "./primitives";

/** A part in the fixed frame. */
export interface PlacedPart {
  readonly part: Part;
  readonly fixed_T_part: Transform;
}

export interface DrawItem extends PlacedPart {
  readonly opacity: number;
  /** Called when the part cannot be drawn. */
  fail(error: unknown): void;
}

/** Where the scene is seen from. */
export interface Viewpoint {
  /** Middle of the picture on the ground, in metres of the fixed frame. */
  centre: [number, number];
  /** Pixels per metre in the middle. */
  scale: number;
  /** 3D only: from which side, and how steeply (π/2: from above). */
  azimuth: number;
  elevation: number;
}

/** A line of sight in the fixed frame; `tolerance` is metres per pixel and metre of depth, or fixed. */
export interface Ray {
  readonly origin: readonly [number, number, number];
  /** Of length one. */
  readonly direction: readonly [number, number, number];
  /** Metres that a pixel is wide, where the ray meets the ground. */
  readonly metresPerPx: number;
}

export interface Renderer {
  readonly canvas: HTMLCanvasElement;
  draw(items: readonly DrawItem[], viewpoint: Viewpoint, background: string): void;
  /** Line of sight through a pixel of the canvas' element. */
  ray(viewpoint: Viewpoint, px: number, py: number): Ray;
  /** Pixel of a point, or null behind the viewer. */
  project(viewpoint: Viewpoint, point: readonly [number, number, number]): [number, number] | null;
  dispose(): void;
}

/** Fit the drawing buffer to the element; true if it changed. */
export function fitCanvas(canvas: HTMLCanvasElement, ratio: number): boolean {
  const width = Math.max(1, Math.round(canvas.clientWidth * ratio));
  const height = Math.max(1, Math.round(canvas.clientHeight * ratio));
  if (canvas.width === width && canvas.height === height) return false;
  canvas.width = width;
  canvas.height = height;
  return true;
}
