/** What lies under a line of sight: the same for both renderers. */

import { apply, inverse, rotate, type Transform, type Vector } from "../transforms/transform";
import { convexHull, isInside } from "./hull";
import type { Hit, Primitive, Solid } from "./primitives";
import type { DrawItem, Ray } from "./renderer";
import { boxAbout, cornersOf } from "./solids";

const REACH_PX = 9;

export interface Pick {
  readonly item: DrawItem;
  readonly primitive: Primitive;
  readonly hit: Hit;
}

/** Everything near the line of sight, the topmost drawn first. */
export function pick(items: readonly DrawItem[], ray: Ray): Pick[] {
  const found: Pick[] = [];
  for (const item of [...items].reverse()) {
    const part_T_fixed = inverse(item.fixed_T_part);
    const local: Ray = {
      origin: apply(part_T_fixed, ray.origin),
      direction: rotate(part_T_fixed.rotation, ray.direction),
      metresPerPx: ray.metresPerPx,
    };
    for (const primitive of item.part.primitives) {
      const hit = hitOf(primitive, local, item.fixed_T_part, ray);
      if (hit) found.push({ item, primitive, hit });
    }
  }
  return found;
}

/** Where a ray meets the plane z = 0 of its frame; null if it does not. */
export function onGround({ origin, direction }: { readonly origin: Vector; readonly direction: Vector }): Vector | null {
  if (Math.abs(direction[2]) < 1e-9) return null;
  const along = -origin[2] / direction[2];
  if (along < 0) return null;
  return [origin[0] + along * direction[0], origin[1] + along * direction[1], 0];
}

function hitOf(primitive: Primitive, ray: Ray, pose: Transform, fixedRay: Ray): Hit | null {
  const reach = REACH_PX * ray.metresPerPx;
  switch (primitive.kind) {
    case "raster": {
      const back = inverse(primitive.pose);
      const point = onGround({ origin: apply(back, ray.origin), direction: rotate(back.rotation, ray.direction) });
      if (!point) return null;
      const column = Math.floor((point[0] / primitive.widthM) * primitive.columns);
      const row = Math.floor((point[1] / primitive.heightM) * primitive.rows);
      if (column < 0 || row < 0 || column >= primitive.columns || row >= primitive.rows) return null;
      const index = row * primitive.columns + column;
      return primitive.pixels[4 * index + 3] ? { point: apply(primitive.pose, point), index } : null;
    }
    case "points":
      return nearest(primitive.positions, ray, reach);
    case "lines":
      return nearestOnLine(primitive.positions, primitive.mode, ray, reach);
    case "sign": {
      const far = distance(primitive.pose.translation, ray);
      return far < Math.max(reach, (primitive.sizePx / 2) * ray.metresPerPx) ? { point: primitive.pose.translation, index: 0 } : null;
    }
    case "label":
      return distance(primitive.position, ray) < 2 * reach ? { point: primitive.position, index: 0 } : null;
    case "solid": {
      // From above exactly; from the side, the box about it.
      const isAbove = Math.abs(fixedRay.direction[2]) > 0.999;
      const inside = isAbove ? isInside(convexHull(cornersOf(primitive, pose)), [fixedRay.origin[0], fixedRay.origin[1]]) : meetsBox(primitive, ray);
      return inside ? { point: primitive.pose.translation, index: 0 } : null;
    }
  }
}

/** Whether a ray in the frame of the part meets the box about a body: between its three pairs of planes at once. */
function meetsBox(solid: Solid, ray: Ray): boolean {
  const solid_T_part = inverse(solid.pose);
  const origin = apply(solid_T_part, ray.origin);
  const direction = rotate(solid_T_part.rotation, ray.direction);
  const { low, high } = boxAbout(solid);
  let [enter, leave] = [0, Infinity];
  for (const axis of [0, 1, 2] as const) {
    const [a, b] = [(low[axis] - origin[axis]) / direction[axis], (high[axis] - origin[axis]) / direction[axis]];
    enter = Math.max(enter, Math.min(a, b));
    leave = Math.min(leave, Math.max(a, b));
  }
  return enter <= leave;
}

/** Distance of a point to the line of sight. */
function distance([x, y, z]: Vector, { origin, direction }: Ray): number {
  const [dx, dy, dz] = [x - origin[0], y - origin[1], z - origin[2]];
  const along = dx * direction[0] + dy * direction[1] + dz * direction[2];
  return Math.sqrt(Math.max(0, dx * dx + dy * dy + dz * dz - along * along));
}

function nearest(positions: Float32Array, ray: Ray, reach: number): Hit | null {
  let [best, index] = [reach, -1];
  for (let at = 0; at + 2 < positions.length; at += 3) {
    const far = distance([positions[at]!, positions[at + 1]!, positions[at + 2]!], ray);
    if (far < best) [best, index] = [far, at / 3];
  }
  return index < 0 ? null : { point: pointAt(positions, index), index };
}

function nearestOnLine(positions: Float32Array, mode: string, ray: Ray, reach: number): Hit | null {
  const count = positions.length / 3;
  const step = mode === "segments" ? 2 : 1;
  for (let index = 0; index + 1 < count; index += step) {
    const [a, b] = [pointAt(positions, index), pointAt(positions, index + 1)];
    const length = Math.hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
    const parts = Math.min(50, Math.max(1, Math.ceil(length / Math.max(reach, 1e-6))));
    for (let part = 0; part <= parts; part++) {
      const share = part / parts;
      const point: Vector = [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2])];
      if (distance(point, ray) < reach) return { point, index };
    }
  }
  return null;
}

function pointAt(positions: Float32Array, index: number): Vector {
  return [positions[3 * index]!, positions[3 * index + 1]!, positions[3 * index + 2]!];
}
