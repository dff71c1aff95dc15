/** What lies under a line of sight: the same for both renderers. */

import { apply, inverse, rotate, type Transform, type Vector } from "../transforms/transform";
import { convexHull, isInside } from "./hull";
import type { Hit, Lines, Primitive, Raster, Solid } from "./primitives";
import type { PlacedPart, Ray } from "./renderer";
import { boxAbout, cornersOf } from "./solids";

const REACH_PX = 9;
/** How far an area counts as for each pixel of its extent: a line over a wall comes before the wall. */
const AREA_SHARE = 0.1;
/** Added to what a body hides. */
const HIDDEN_PX = 1e6;

export interface Pick {
  readonly item: PlacedPart;
  readonly primitive: Primitive;
  readonly hit: Hit;
}

/** A hit in the frame of its part, and its distance on the screen or what an area counts as. */
interface Found extends Hit {
  readonly farPx: number;
}

/** Everything near the line of sight: the nearest first, small things before large areas. */
export function pick(items: readonly PlacedPart[], ray: Ray): Pick[] {
  const found: (Pick & { farPx: number; depthM: number })[] = [];
  let firstBodyM = Infinity;
  for (const item of [...items].reverse()) {
    const part_T_fixed = inverse(item.fixed_T_part);
    const local: Ray = {
      origin: apply(part_T_fixed, ray.origin),
      direction: rotate(part_T_fixed.rotation, ray.direction),
      metresPerPx: ray.metresPerPx,
    };
    for (const primitive of item.part.primitives) {
      const hit = primitive.kind === "solid" ? hitBody(primitive, local, item.fixed_T_part, ray) : hitOf(primitive, local);
      if (!hit) continue;
      const depthM = along(hit.point, local);
      if (primitive.kind === "solid") firstBodyM = Math.min(firstBodyM, depthM);
      found.push({ item, primitive, hit, farPx: hit.farPx, depthM });
    }
  }
  const hiddenM = isFromAbove(ray) ? Infinity : firstBodyM + REACH_PX * ray.metresPerPx;
  const order = ({ farPx, depthM }: { farPx: number; depthM: number }): number => farPx + (depthM > hiddenM ? HIDDEN_PX : 0);
  return found.sort((one, other) => order(one) - order(other)); // of equals the topmost
}

/** Where a ray meets the plane z = 0 of its frame; null if it does not. */
export function onGround({ origin, direction }: { readonly origin: Vector; readonly direction: Vector }): Vector | null {
  if (Math.abs(direction[2]) < 1e-9) return null;
  const along = -origin[2] / direction[2];
  if (along < 0) return null;
  return [origin[0] + along * direction[0], origin[1] + along * direction[1], 0];
}

function hitOf(primitive: Exclude<Primitive, Solid>, ray: Ray): Found | null {
  switch (primitive.kind) {
    case "raster":
      return hitCell(primitive, ray);
    case "points":
      return nearestPoint(primitive.positions, ray);
    case "lines":
      return hitLines(primitive, ray);
    case "sign":
      return near(primitive.pose.translation, ray, Math.max(REACH_PX, primitive.sizePx / 2));
    case "label":
      return near(primitive.position, ray, 2 * REACH_PX);
  }
}

function hitCell(raster: Raster, ray: Ray): Found | null {
  const back = inverse(raster.pose);
  const point = onGround({ origin: apply(back, ray.origin), direction: rotate(back.rotation, ray.direction) });
  if (!point) return null;
  const column = Math.floor((point[0] / raster.widthM) * raster.columns);
  const row = Math.floor((point[1] / raster.heightM) * raster.rows);
  if (column < 0 || row < 0 || column >= raster.columns || row >= raster.rows) return null;
  const index = row * raster.columns + column;
  if (!raster.pixels[4 * index + 3]) return null;
  return { point: apply(raster.pose, point), index, farPx: areaPx(Math.max(raster.widthM, raster.heightM), ray) };
}

/** From above exactly; from the side, the box about it. */
function hitBody(solid: Solid, ray: Ray, fixed_T_part: Transform, fixedRay: Ray): Found | null {
  const { low, high } = boxAbout(solid);
  const farPx = areaPx(Math.hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]), ray);
  if (isFromAbove(fixedRay)) {
    const [x, y] = fixedRay.origin;
    return isInside(convexHull(cornersOf(solid, fixed_T_part)), [x, y]) ? { point: solid.pose.translation, index: 0, farPx } : null;
  }
  const enterM = meetsBox(solid, low, high, ray);
  return enterM === null ? null : { point: at(ray, enterM), index: 0, farPx };
}

function isFromAbove({ direction }: Ray): boolean {
  return Math.abs(direction[2]) > 0.999;
}

function areaPx(extentM: number, { metresPerPx }: Ray): number {
  return (AREA_SHARE * extentM) / metresPerPx;
}

/** Metres along a ray in the frame of the part to the box about a body: between its three pairs of planes at once. */
function meetsBox({ pose }: Solid, low: Vector, high: Vector, ray: Ray): number | null {
  const solid_T_part = inverse(pose);
  const origin = apply(solid_T_part, ray.origin);
  const direction = rotate(solid_T_part.rotation, ray.direction);
  let [enter, leave] = [0, Infinity];
  for (const axis of [0, 1, 2] as const) {
    const [a, b] = [(low[axis] - origin[axis]) / direction[axis], (high[axis] - origin[axis]) / direction[axis]];
    enter = Math.max(enter, Math.min(a, b));
    leave = Math.min(leave, Math.max(a, b));
  }
  return enter <= leave ? enter : null;
}

function at({ origin, direction }: Ray, alongM: number): Vector {
  return [origin[0] + alongM * direction[0], origin[1] + alongM * direction[1], origin[2] + alongM * direction[2]];
}

/** Metres along the line of sight to the place beside a point. */
function along([x, y, z]: Vector, { origin, direction }: Ray): number {
  return (x - origin[0]) * direction[0] + (y - origin[1]) * direction[1] + (z - origin[2]) * direction[2];
}

/** From the line of sight to a point, square to it. */
function aside(point: Vector, ray: Ray): Vector {
  const [x, y, z] = at(ray, along(point, ray));
  return [point[0] - x, point[1] - y, point[2] - z];
}

function near(point: Vector, ray: Ray, reachPx: number, index = 0): Found | null {
  const farPx = Math.hypot(...aside(point, ray)) / ray.metresPerPx;
  return farPx < reachPx ? { point, index, farPx } : null;
}

function nearestPoint(positions: Float32Array, ray: Ray): Found | null {
  let best = null as Found | null;
  for (let index = 0; 3 * index + 2 < positions.length; index++) {
    best = near(pointAt(positions, index), ray, best?.farPx ?? REACH_PX, index) ?? best;
  }
  return best;
}

/** The nearest place on the lines, else the area that they fill. */
function hitLines({ positions, mode, fill }: Lines, ray: Ray): Found | null {
  const count = positions.length / 3;
  const last = mode === "loop" ? count : count - 1;
  let best = null as Found | null;
  for (let index = 0; index < last; index += mode === "segments" ? 2 : 1) {
    const [a, b] = [pointAt(positions, index), pointAt(positions, (index + 1) % count)];
    const [from, to] = [aside(a, ray), aside(b, ray)];
    const step: Vector = [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
    const square = step[0] ** 2 + step[1] ** 2 + step[2] ** 2;
    const onto = -(from[0] * step[0] + from[1] * step[1] + from[2] * step[2]) / square;
    const share = square > 0 ? Math.min(1, Math.max(0, onto)) : 0;
    const point: Vector = [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2])];
    best = near(point, ray, best?.farPx ?? REACH_PX, index) ?? best;
  }
  return best ?? (fill === undefined ? null : hitFilled(positions, ray));
}

/** Inside a filled outline, which lies flat in its frame. */
function hitFilled(positions: Float32Array, ray: Ray): Found | null {
  const height = positions[2] ?? 0;
  const ground = onGround({ origin: [ray.origin[0], ray.origin[1], ray.origin[2] - height], direction: ray.direction });
  const corners = Array.from({ length: positions.length / 3 }, (_, index) => [positions[3 * index]!, positions[3 * index + 1]!] as const);
  if (!ground || !isInside(corners, [ground[0], ground[1]])) return null;
  const [xs, ys] = [corners.map(([x]) => x), corners.map(([, y]) => y)];
  const extentM = Math.max(Math.max(...xs) - Math.min(...xs), Math.max(...ys) - Math.min(...ys));
  return { point: [ground[0], ground[1], height], index: 0, farPx: areaPx(extentM, ray) };
}

function pointAt(positions: Float32Array, index: number): Vector {
  return [positions[3 * index]!, positions[3 * index + 1]!, positions[3 * index + 2]!];
}
