/** What the page computes from the robot's motion: footprint, trail, contacts; the frames; the grid; the goal. */

import { fixed } from "../../robot/text";
import { Display } from "../display";
import { transformOf, valuesOf, type DiagnosticArray, type Odometry } from "../messages";
import { Placement } from "../placement";
import { faded, type Part, type Primitive } from "../primitives";
import { nanosecondsOf } from "../../transforms/stamp";
import { apply, IDENTITY, yawOf, type Transform, type Vector } from "../../transforms/transform";
import { covarianceEllipse } from "./poses";

const APART_M = 0.05;
const JUMP_M = 2;
const MOST_POINTS = 20_000;

/**
 * nav_msgs/Odometry: the driven path, the newest pose, its covariance.
 *
 * Each point of the path is placed once, by the transforms of its stamp, as in RViz: a later
 * correction of the map's odometry does not move what was driven before.
 */
export class OdometryDisplay extends Display<Odometry> {
  /** In #trailFrame. */
  #trail: number[] = [];
  #trailFrame = "";
  /** The newest point, in the frame of the messages. */
  #last: Vector | null = null;
  #frame = "";

  protected override take(value: Odometry): void {
    this.message = value;
    const { frame_id: frame, stamp } = value.header;
    const { x, y, z } = value.pose.pose.position;
    const apart = this.#last === null ? Infinity : Math.hypot(x - this.#last[0], y - this.#last[1]);
    if (frame !== this.#frame || apart > JUMP_M) this.#trail = []; // another run
    this.#frame = frame;
    if (!(apart > APART_M)) return;
    this.#last = [x, y, z];
    const { transforms, fixedFrame } = this.around;
    const fixed_T_frame = fixedFrame === null ? null : new Placement(transforms, frame, nanosecondsOf(stamp)).in(fixedFrame);
    this.#moveTrail(fixed_T_frame && fixedFrame !== null ? fixedFrame : frame);
    this.#trail.push(...apply(fixed_T_frame ?? IDENTITY, this.#last));
    if (this.#trail.length > 3 * MOST_POINTS) this.#trail.splice(0, 3 * 1000);
  }

  override clear(): void {
    this.#trail = [];
    this.#last = null;
    super.clear();
  }

  protected override build(): Part[] {
    if (!this.message) return [];
    const newest: Primitive[] = [];
    const trail: Primitive[] = [];
    const { pose, covariance } = this.message.pose;
    if (this.#trail.length > 3) {
      const positions = Float32Array.from(this.#trail);
      trail.push({ kind: "lines", positions, mode: "strip", colour: this.colour, widthPx: this.size });
    }
    const ellipse = covarianceEllipse(covariance, transformOf(pose));
    if (ellipse) newest.push({ kind: "lines", positions: ellipse, mode: "loop", colour: this.colour, widthPx: 1, fill: faded(this.colour, 0.12) });
    const about = (): [string, string][] => this.#about();
    return [{ frame: this.#frame, primitives: newest, about }, { frame: this.#trailFrame, primitives: trail, about }];
  }

  /** Another fixed frame: take the trail there as it is seen now. */
  #moveTrail(frame: string): void {
    if (frame === this.#trailFrame) return;
    const frame_T_trail = this.around.transforms.lookUp(frame, this.#trailFrame);
    const moved: number[] = [];
    for (let index = 0; frame_T_trail && index < this.#trail.length; index += 3) {
      moved.push(...apply(frame_T_trail, [this.#trail[index]!, this.#trail[index + 1]!, this.#trail[index + 2]!]));
    }
    this.#trail = moved;
    this.#trailFrame = frame;
  }

  #about(): [string, string][] {
    const { linear, angular } = this.message?.twist.twist ?? { linear: { x: 0, y: 0 }, angular: { z: 0 } };
    return [["speed", `${fixed(linear.x, 2)} m/s`], ["turn rate", `${fixed(angular.z, 2)} rad/s`]];
  }

  protected override isEmpty(): boolean {
    return !this.message;
  }

  protected override detail(): string {
    const { x, y } = this.message?.pose.pose.position ?? { x: 0, y: 0 };
    return `at ${fixed(x, 2)}, ${fixed(y, 2)} m`;
  }
}

/** The footprint at the base frame, with its heading. */
export class RobotDisplay extends Display {
  /** Corners in the base frame: x, y, x, y …; of the parameter footprint_m. */
  outline: readonly number[] = [];
  frame: string | null = null;

  protected override build(): Part[] {
    if (this.frame === null) return [];
    const pose = IDENTITY;
    if (this.outline.length < 6) return [{ frame: this.frame, primitives: [{ kind: "sign", shape: "arrow", pose, sizePx: 18, colour: this.colour }] }];
    const corners: number[] = [];
    let nose = 0;
    for (let index = 0; index + 1 < this.outline.length; index += 2) {
      corners.push(this.outline[index]!, this.outline[index + 1]!, 0);
      nose = Math.max(nose, this.outline[index]!);
    }
    const arrow = [0.8 * nose, 0, 0, 0.3 * nose, 0.22 * nose, 0, 0.3 * nose, -0.22 * nose, 0];
    return [{
      frame: this.frame,
      primitives: [
        { kind: "lines", positions: Float32Array.from(corners), mode: "loop", colour: this.colour, widthPx: 2, fill: this.around.theme.colour("body") },
        { kind: "lines", positions: Float32Array.from(arrow), mode: "loop", colour: this.colour, widthPx: 1, fill: this.colour },
      ],
    }];
  }

  override status(): ReturnType<Display["status"]> {
    return this.frame === null && this.isVisible ? { level: "empty", text: "no odometry yet" } : super.status();
  }

  protected override detail(): string {
    return this.outline.length < 6 ? "footprint not known" : `${this.outline.length / 2} corners`;
  }
}

/** diagnostic_msgs/DiagnosticArray on /contacts: a mark where the robot touched something. */
export class ContactsDisplay extends Display<DiagnosticArray> {
  protected override build(): Part[] {
    const contacts = this.#placed();
    const frames = new Set(contacts.map(({ frame }) => frame));
    return [...frames].map((frame) => {
      const here = contacts.filter((contact) => contact.frame === frame);
      const signs = here.map(({ place }) => ({ kind: "sign", shape: "cross", pose: { ...IDENTITY, translation: place }, sizePx: this.size, colour: this.colour }) as const);
      return { frame, primitives: signs, about: (primitive) => here[signs.indexOf(primitive as never)]?.about ?? [] };
    });
  }

  #placed(): { frame: string; place: Vector; about: [string, string][] }[] {
    return (this.message?.status ?? []).flatMap((status) => {
      const { frame, x_m, y_m, z_m = "0", time_s } = valuesOf(status);
      const place: Vector = [Number(x_m), Number(y_m), Number(z_m)];
      if (frame === undefined || !place.every(Number.isFinite)) return [];
      const time: [string, string][] = time_s === undefined ? [] : [["at", `${fixed(Number(time_s), 1)} s`]];
      return [{ frame, place, about: [["contact", status.message], ...time] }];
    });
  }

  override status(): ReturnType<Display["status"]> {
    const status = super.status();
    return status.text === "no messages yet" ? { level: "ok", text: "no contacts" } : status;
  }

  protected override isEmpty(): boolean {
    return false;
  }

  protected override detail(): string {
    const count = this.message?.status.length ?? 0;
    return count === 0 ? "no contacts" : count === 1 ? "1 contact" : `${count} contacts`;
  }
}

/** Axes and names of all frames that connect to the fixed one. */
export class FramesDisplay extends Display {
  protected override build(): Part[] {
    const { transforms, fixedFrame, theme } = this.around;
    const axes = [["bad", [1, 0, 0]], ["good", [0, 1, 0]], ["sea", [0, 0, 1]]] as const;
    const length = this.size;
    return transforms.frames
      .filter((frame) => fixedFrame !== null && transforms.lookUp(fixedFrame, frame) !== null)
      .map((frame) => {
        const lines = axes.map(([name, [x, y, z]]) => ({
          kind: "lines", positions: Float32Array.from([0, 0, 0, length * x, length * y, length * z]),
          mode: "segments", colour: theme.colour(name), widthPx: 2,
        }) as const);
        const parent = transforms.links.get(frame)?.parent;
        const label = { kind: "label", position: [0, 0, 0], text: frame, colour: theme.colour("quiet"), sizePx: 11 } as const;
        return { frame, primitives: [...lines, label], about: () => [["frame", frame], ["parent", parent ?? "none"]] };
      });
  }

  protected override isEmpty(): boolean {
    return this.around.transforms.frames.length === 0;
  }

  protected override detail(): string {
    return this.isEmpty() ? "no transforms yet" : `${this.around.transforms.frames.length} frames`;
  }
}

/** The goal that the robot drives to, from any node, and waypoints after it. */
export class GoalDisplay extends Display {
  #goals: readonly { frame: string; pose: Transform; hasHeading: boolean }[] = [];

  set(goals: readonly { frame: string; pose: Transform; hasHeading: boolean }[]): void {
    if (JSON.stringify(goals) === JSON.stringify(this.#goals)) return;
    this.#goals = goals;
    this.restyle();
  }

  get goals(): readonly { frame: string; pose: Transform }[] {
    return this.#goals;
  }

  protected override build(): Part[] {
    return this.#goals.map(({ frame, pose, hasHeading }) => {
      const sign = { kind: "sign", shape: "goal", pose, sizePx: this.size, colour: this.colour } as const;
      const arrow = { kind: "sign", shape: "arrow", pose, sizePx: 1.6 * this.size, colour: this.colour } as const;
      const [x, y] = pose.translation;
      const heading = hasHeading ? [["heading", `${fixed((yawOf(pose.rotation) * 180) / Math.PI, 0)}°`] as const] : [];
      return {
        frame,
        primitives: hasHeading ? [sign, arrow] : [sign],
        about: () => [["position", `${fixed(x, 2)}, ${fixed(y, 2)} m`], ...heading],
      };
    });
  }

  override status(): ReturnType<Display["status"]> {
    const status = super.status();
    return status.level === "empty" ? { level: "ok", text: "no goal" } : status;
  }
}

/** Lines every metre, or as far apart as the zoom allows. */
export class GroundGridDisplay extends Display {
  /** left, low, right, high of what is visible, and metres per pixel. */
  view: readonly [number, number, number, number, number] = [-10, -10, 10, 10, 0.02];

  /** The fixed frame that the lines are in: it changes without the view, as after a seek. */
  #frame: string | null = null;

  show(view: readonly [number, number, number, number, number]): void {
    const frame = this.around.fixedFrame;
    if (frame === this.#frame && view.every((value, index) => value === this.view[index])) return;
    this.view = view;
    this.#frame = frame;
    this.restyle();
  }

  /** Metres between two lines. */
  get stepM(): number {
    const metresPerPx = this.view[4];
    return [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100].find((metres) => metres > 45 * metresPerPx) ?? 200;
  }

  protected override build(): Part[] {
    const frame = this.around.fixedFrame;
    if (frame === null) return [];
    const [left, low, right, high] = this.view;
    const step = this.stepM;
    const positions: number[] = [];
    for (const x of multiples(step, left, right)) positions.push(x, low, 0, x, high, 0);
    for (const y of multiples(step, low, high)) positions.push(left, y, 0, right, y, 0);
    return [{ frame, primitives: [{ kind: "lines", positions: Float32Array.from(positions), mode: "segments", colour: this.colour, widthPx: 1 }] }];
  }

  protected override detail(): string {
    return `${this.stepM} m`;
  }
}

/** Multiples of a step from low to high, counted: far from the origin a sum with the step may be the same number. */
function multiples(step: number, low: number, high: number): number[] {
  const first = Math.ceil(low / step);
  const count = Math.floor(high / step) - first + 1;
  return Array.from({ length: Math.max(0, count) }, (_, index) => (first + index) * step);
}
