/** Moves the viewpoint: pan, zoom, turn, follow the robot, fit to what is known. */

import type { Dispose } from "../connection/connection";
import { apply, type Transform } from "../transforms/transform";
import type { Viewpoint } from "./renderer";

const LOWEST_SCALE = 0.5;
const HIGHEST_SCALE = 1000;
/** Extent of the smallest part that a fit shows: the first cells of a map are less. */
const LEAST_M = 3;
/** Part of the picture that a fit leaves free at each side. */
const MARGIN = 0.07;
/** Between what covers the scene and what a fit shows. */
const MARGIN_PX = 10;
/** Part of the way to the fitted view that a frame goes. */
const EASE = 0.2;

/** Angle of view of the camera in 3D, from top to bottom. */
export const FIELD_DEG = 45;

/** Fit and follow go on until the view is moved. */
export type ViewMode = "fit" | "follow" | "free";

/** Size of the scene in pixels, and how much of it bars cover at the left and the top. */
export interface Room {
  readonly width: number;
  readonly height: number;
  readonly coveredLeft: number;
  readonly coveredTop: number;
}

export type Box = readonly [left: number, low: number, right: number, high: number];

export class Viewing {
  readonly viewpoint: Viewpoint = { centre: [0, 0], scale: 40, azimuth: -Math.PI / 2, elevation: 0.9 };
  #mode: ViewMode = "fit";
  #isPlaced = false;
  readonly #listeners = new Set<() => void>();

  constructor(private readonly invalidate: () => void) {}

  get mode(): ViewMode {
    return this.#mode;
  }

  onChange(callback: () => void): Dispose {
    this.#listeners.add(callback);
    return () => this.#listeners.delete(callback);
  }

  setMode(mode: ViewMode): void {
    if (this.#mode === mode) return;
    this.#mode = mode;
    this.#changed();
  }

  centreOn(x: number, y: number): void {
    if (this.viewpoint.centre[0] === x && this.viewpoint.centre[1] === y) return;
    this.viewpoint.centre = [x, y];
    this.invalidate();
  }

  /** By metres of the ground. */
  pan(dx: number, dy: number): void {
    this.setMode("free");
    this.viewpoint.centre = [this.viewpoint.centre[0] + dx, this.viewpoint.centre[1] + dy];
    this.#changed();
  }

  /** About a place, which stays under the pointer unless the view follows the robot. */
  zoom(factor: number, about: readonly [number, number] | null): void {
    const { viewpoint } = this;
    if (this.#mode === "fit") this.#mode = "free";
    const scale = Math.min(HIGHEST_SCALE, Math.max(LOWEST_SCALE, viewpoint.scale * factor));
    const real = viewpoint.scale / scale;
    if (about && this.#mode !== "follow") {
      const [x, y] = viewpoint.centre;
      viewpoint.centre = [about[0] + (x - about[0]) * real, about[1] + (y - about[1]) * real];
    }
    viewpoint.scale = scale;
    this.#changed();
  }

  turn(azimuth: number, elevation: number): void {
    this.viewpoint.azimuth += azimuth;
    this.viewpoint.elevation = Math.min(Math.PI / 2 - 0.001, Math.max(0.05, this.viewpoint.elevation + elevation));
    this.#changed();
  }

  /** Move towards a view of the box; at once the first time. */
  fit(box: Box, { width, height, coveredLeft, coveredTop }: Room, isThreeDimensional = false): void {
    const [left, low, right, high] = box;
    const { viewpoint } = this;
    const share = this.#isPlaced ? EASE : 1;
    this.#isPlaced = true;
    const [sidePx, endPx] = [MARGIN * width, MARGIN * height];
    const [leftPx, topPx] = [Math.max(sidePx, coveredLeft + MARGIN_PX), Math.max(endPx, coveredTop + MARGIN_PX)];
    const free: [number, number] = [width - leftPx - sidePx, height - topPx - endPx];
    const size: [number, number] = [Math.max(right - left, LEAST_M), Math.max(high - low, LEAST_M)];
    const most = isThreeDimensional ? this.#perspectiveScale(size, free, height) : Math.min(free[0] / size[0], free[1] / size[1]);
    const scale = Math.min(HIGHEST_SCALE, Math.max(LOWEST_SCALE, most));
    const ratio = scale / viewpoint.scale;
    const [middleX, middleY] = [(left + right) / 2 - (leftPx - sidePx) / 2 / scale, (low + high) / 2 + (topPx - endPx) / 2 / scale];
    const [dx, dy] = [middleX - viewpoint.centre[0], middleY - viewpoint.centre[1]];
    if (Math.abs(ratio - 1) < 0.002 && Math.hypot(dx, dy) * viewpoint.scale < 0.5) return;
    viewpoint.scale *= ratio ** share;
    viewpoint.centre = [viewpoint.centre[0] + dx * share, viewpoint.centre[1] + dy * share];
    this.invalidate();
  }

  /** Pixels per metre in the middle with which the near edge of an area on the ground is visible, too. */
  #perspectiveScale([x, y]: readonly [number, number], [freeWidth, freeHeight]: readonly [number, number], heightPx: number): number {
    const { azimuth, elevation } = this.viewpoint;
    const [alongX, alongY] = [Math.abs(Math.cos(azimuth)), Math.abs(Math.sin(azimuth))];
    const [wide, deep] = [x * alongY + y * alongX, x * alongX + y * alongY];
    const eyePx = heightPx / Math.tan((FIELD_DEG * Math.PI) / 360) / 2;
    const nearer = (deep * Math.cos(elevation)) / 2 / eyePx;
    return 1 / Math.max(wide / freeWidth + nearer, (deep * Math.sin(elevation)) / freeHeight + nearer);
  }

  /** The next fit comes at once: what is drawn is another world. */
  replace(): void {
    this.#isPlaced = false;
  }

  #changed(): void {
    this.invalidate();
    for (const callback of this.#listeners) callback();
  }
}

/** The box around boxes; null for none. */
export function unionOf(boxes: readonly Box[]): Box | null {
  if (boxes.length === 0) return null;
  const part = (index: 0 | 1 | 2 | 3, choose: (...values: number[]) => number): number => choose(...boxes.map((box) => box[index]));
  return [part(0, Math.min), part(1, Math.min), part(2, Math.max), part(3, Math.max)];
}

/** The box about a box of another frame, seen from above. */
export function boxIn(pose: Transform, [left, low, right, high]: Box): Box {
  const corners = [[left, low], [right, low], [right, high], [left, high]] as const;
  return unionOf(corners.map(([x, y]) => {
    const [px, py] = apply(pose, [x, y, 0]);
    return [px, py, px, py];
  }))!;
}
