/** Points on the surface of bodies: what their outline from above spans. */

import { apply, compose, type Transform, type Vector } from "../transforms/transform";
import type { Solid } from "./primitives";

const ROUND = 16;
/** Vertices of a mesh that its outline is made of. */
const MOST_VERTICES = 600;

/** Corners of a body in the fixed frame, from above. */
export function cornersOf(solid: Solid, fixed_T_part: Transform): [number, number][] {
  const fixed_T_solid = compose(fixed_T_part, solid.pose);
  return surface(solid).map((point) => {
    const [x, y] = apply(fixed_T_solid, point);
    return [x, y];
  });
}

/** Lowest and highest coordinates of a body, in its own frame. */
export function boxAbout(solid: Solid): { low: Vector; high: Vector } {
  const low: [number, number, number] = [Infinity, Infinity, Infinity];
  const high: [number, number, number] = [-Infinity, -Infinity, -Infinity];
  for (const point of surface(solid)) {
    for (const axis of [0, 1, 2] as const) {
      low[axis] = Math.min(low[axis], point[axis]);
      high[axis] = Math.max(high[axis], point[axis]);
    }
  }
  return { low, high };
}

function surface({ shape, size: [sx, sy, sz], mesh }: Solid): Vector[] {
  const points: Vector[] = [];
  if (shape === "box") {
    for (const x of [-sx / 2, sx / 2]) for (const y of [-sy / 2, sy / 2]) for (const z of [-sz / 2, sz / 2]) points.push([x, y, z]);
  } else if (shape === "cylinder") {
    for (let index = 0; index < ROUND; index++) {
      const angle = (2 * Math.PI * index) / ROUND;
      for (const z of [-sz / 2, sz / 2]) points.push([(sx / 2) * Math.cos(angle), (sy / 2) * Math.sin(angle), z]);
    }
  } else if (shape === "sphere") {
    for (let index = 0; index < ROUND; index++) {
      const angle = (2 * Math.PI * index) / ROUND;
      const [c, s] = [Math.cos(angle) / 2, Math.sin(angle) / 2];
      points.push([sx * c, sy * s, 0], [sx * c, 0, sz * s], [0, sy * c, sz * s]);
    }
  } else if (mesh) {
    const count = mesh.positions.length / 3;
    const stride = Math.max(1, Math.floor(count / MOST_VERTICES));
    for (let index = 0; index < count; index += stride) {
      const at = 3 * index;
      points.push([sx * mesh.positions[at]!, sy * mesh.positions[at + 1]!, sz * mesh.positions[at + 2]!]);
    }
  }
  return points;
}
