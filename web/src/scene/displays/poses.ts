/** Paths, poses, polygons and points. */

import { fixed } from "../../robot/text";
import {
  transformOf, type Header, type ParticleCloud, type Path, type PointStamped, type PolygonStamped, type PoseArray, type PoseStamped,
  type PoseWithCovarianceStamped,
} from "../messages";
import { faded, type Part, type Primitive } from "../primitives";
import { StampedDisplay } from "../stamped_display";
import { yawOf, type Transform } from "../../transforms/transform";

export class PathDisplay extends StampedDisplay<Path> {
  #lengthM = 0;

  protected override build(): Part[] {
    const path = this.message;
    if (!path) return [];
    const positions = new Float32Array(3 * path.poses.length);
    this.#lengthM = 0;
    path.poses.forEach(({ pose: { position: p } }, index) => {
      positions.set([p.x, p.y, p.z], 3 * index);
      if (index > 0) this.#lengthM += Math.hypot(p.x - positions[3 * index - 3]!, p.y - positions[3 * index - 2]!);
    });
    const line = { kind: "lines", positions, mode: "strip", colour: this.colour, widthPx: this.size } as const;
    return [{
      frame: this.headerOf(path).frame_id,
      primitives: path.poses.length > 1 ? [line] : [],
      about: () => [["length", `${fixed(this.#lengthM, 2)} m`], ["poses", String(path.poses.length)]],
    }];
  }

  protected override headerOf({ header, poses }: Path): Header {
    return header.frame_id ? header : (poses[0]?.header ?? header);
  }

  protected override detail(): string {
    return this.message?.poses.length ? `${fixed(this.#lengthM, 1)} m, ${this.message.poses.length} poses` : "the path is empty";
  }
}

type AnyPoses = PoseStamped | PoseWithCovarianceStamped | PoseArray | ParticleCloud;

/** PoseStamped, PoseWithCovarianceStamped, PoseArray, ParticleCloud: arrows, with covariance. */
export class PosesDisplay extends StampedDisplay<AnyPoses> {
  protected override build(): Part[] {
    const value = this.message;
    if (!value) return [];
    const poses = posesOf(value);
    const primitives: Primitive[] = [];
    if (poses.length > 60) primitives.push(...this.#cloud(poses));
    else for (const pose of poses) primitives.push({ kind: "sign", shape: "arrow", pose, sizePx: this.size, colour: this.colour });
    if ("pose" in value && "covariance" in value.pose) {
      const ellipse = covarianceEllipse(value.pose.covariance, transformOf(value.pose.pose));
      if (ellipse) {
        primitives.unshift({ kind: "lines", positions: ellipse, mode: "loop", colour: this.colour, widthPx: 1.5, fill: faded(this.colour, 0.15) });
      }
    }
    return [{ frame: value.header.frame_id, primitives, about: (primitive) => aboutPose(primitive) }];
  }

  /** Many poses: a short line each, in one primitive. */
  #cloud(poses: readonly Transform[]): Primitive[] {
    const lines = new Float32Array(6 * poses.length);
    const points = new Float32Array(3 * poses.length);
    const lengthM = 0.012 * this.size;
    poses.forEach(({ translation: [x, y, z], rotation }, index) => {
      const yaw = yawOf(rotation);
      lines.set([x, y, z, x + lengthM * Math.cos(yaw), y + lengthM * Math.sin(yaw), z], 6 * index);
      points.set([x, y, z], 3 * index);
    });
    return [
      { kind: "lines", positions: lines, mode: "segments", colour: faded(this.colour, 0.6), widthPx: 1 },
      { kind: "points", positions: points, colour: this.colour, sizePx: 2.5 },
    ];
  }

  protected override detail(): string {
    const count = this.message ? posesOf(this.message).length : 0;
    return count === 1 ? "1 pose" : `${count} poses`;
  }
}

function posesOf(value: AnyPoses): Transform[] {
  if ("poses" in value) return value.poses.map(transformOf);
  if ("particles" in value) return value.particles.map(({ pose }) => transformOf(pose));
  return [transformOf("covariance" in value.pose ? value.pose.pose : value.pose)];
}

function aboutPose(primitive: Primitive): [string, string][] {
  if (primitive.kind !== "sign") return [];
  const { translation: [x, y], rotation } = primitive.pose;
  return [["pose", `${fixed(x, 2)}, ${fixed(y, 2)} m, ${fixed((yawOf(rotation) * 180) / Math.PI, 0)}°`]];
}

/** Two standard deviations of x and y about the pose; null without a covariance. */
export function covarianceEllipse(covariance: ArrayLike<number>, pose: Transform): Float32Array | null {
  const [a, b, c] = [covariance[0] ?? 0, covariance[1] ?? 0, covariance[7] ?? 0];
  const middle = (a + c) / 2;
  const apart = Math.hypot((a - c) / 2, b);
  const [large, small] = [Math.sqrt(Math.max(0, middle + apart)), Math.sqrt(Math.max(0, middle - apart))];
  if (!(large > 1e-4) || !Number.isFinite(large) || large > 1e4) return null;
  const turn = 0.5 * Math.atan2(2 * b, a - c);
  const [x, y, z] = pose.translation;
  const positions = new Float32Array(3 * 48);
  for (let index = 0; index < 48; index++) {
    const angle = (index / 48) * 2 * Math.PI;
    const [u, v] = [2 * large * Math.cos(angle), 2 * small * Math.sin(angle)];
    positions.set([x + u * Math.cos(turn) - v * Math.sin(turn), y + u * Math.sin(turn) + v * Math.cos(turn), z], 3 * index);
  }
  return positions;
}

export class PolygonDisplay extends StampedDisplay<PolygonStamped> {
  protected override build(): Part[] {
    const value = this.message;
    if (!value) return [];
    const positions = Float32Array.from(value.polygon.points.flatMap(({ x, y, z }) => [x, y, z]));
    const loop = { kind: "lines", positions, mode: "loop", colour: this.colour, widthPx: this.size, fill: faded(this.colour, 0.1) } as const;
    return [{ frame: value.header.frame_id, primitives: positions.length > 3 ? [loop] : [] }];
  }

  protected override detail(): string {
    return `${this.message?.polygon.points.length ?? 0} corners`;
  }
}

export class PointDisplay extends StampedDisplay<PointStamped> {
  protected override build(): Part[] {
    const value = this.message;
    if (!value) return [];
    const { x, y, z } = value.point;
    const pose: Transform = { translation: [x, y, z], rotation: [0, 0, 0, 1] };
    return [{ frame: value.header.frame_id, primitives: [{ kind: "sign", shape: "ring", pose, sizePx: this.size, colour: this.colour }] }];
  }

  protected override detail(): string {
    const point = this.message?.point;
    return point ? `${fixed(point.x, 2)}, ${fixed(point.y, 2)} m` : "";
  }
}
