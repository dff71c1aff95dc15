/** The robot as the page knows it: pose, goal, statuses of the stages, who commands, contacts. */

import type { Connection, Dispose } from "../connection/connection";
import { transformOf, valuesOf, type DiagnosticArray, type DiagnosticStatus, type Odometry, type PointStamped, type PoseStamped } from "../scene/messages";
import { nanosecondsOf } from "../transforms/stamp";
import { apply, fromYaw, yawOf, type Transform } from "../transforms/transform";
import type { TransformTree } from "../transforms/transform_tree";
import {
  COMMANDER, CONTACTS, CONTROL_STATUS, DRIVE, GOAL_POINT, GOAL_POSE, ODOMETRY, OUTLINE, PLANNER_STATUS, PLAYER,
} from "./names";

/** A status gives three decimals, the page sends more. */
const SAME_GOAL_M = 0.06;
const BASES = ["base_link", "base_footprint", "robot"];

export interface StageStatus {
  readonly level: number;
  readonly message: string;
  readonly values: Record<string, string>;
  /** The robot's time. */
  receivedNs: bigint;
}

export interface Goal {
  readonly frame: string;
  readonly x: number;
  readonly y: number;
  /** null: any heading. */
  readonly yaw: number | null;
}

export interface Motion {
  readonly frame: string;
  readonly x: number;
  readonly y: number;
  readonly yawDeg: number;
  readonly speedMps: number;
  readonly receivedMs: number;
}

export type Stage = "planner" | "control" | "arbiter";

export class RobotState {
  readonly stages = new Map<Stage, StageStatus>();
  motion: Motion | null = null;
  baseFrame: string | null = null;
  /** Corners of the footprint in the base frame: x, y, x, y … */
  outline: readonly number[] = [];
  contacts = 0;
  /** Why the last goal of this page was refused; called once per goal. */
  onRefused: (reason: string) => void = () => undefined;
  /** The newest goal on a topic. */
  #goal: Goal | null = null;
  /** The goal of this page, until the planner has reported on it. */
  #sent: Goal | null = null;
  /** goal_id of the planner's last report on a goal of this page. */
  #reported = "";
  #odometry: { topic: string; end: Dispose } | null = null;
  readonly #listeners = new Set<() => void>();

  constructor(
    readonly connection: Connection,
    readonly transforms: TransformTree,
  ) {
    const stage = (topic: string, name: Stage): void => {
      connection.subscribe<DiagnosticStatus>(topic, { every: true }, ({ value }) => this.#onStage(name, value));
    };
    stage(PLANNER_STATUS, "planner");
    stage(CONTROL_STATUS, "control");
    stage(COMMANDER, "arbiter");
    connection.subscribe<DiagnosticArray>(CONTACTS, {}, ({ type, value }) => {
      if (type !== "diagnostic_msgs/msg/DiagnosticArray") return;
      const newest = value.status.at(-1); // the message has the newest contacts only
      this.contacts = Math.max(value.status.length, Number(newest && valuesOf(newest)["count"]) || 0);
      this.#notify();
    });
    connection.subscribe<PointStamped>(GOAL_POINT, { every: true }, ({ value: { header, point } }) => {
      this.#onGoal({ frame: header.frame_id, x: point.x, y: point.y, yaw: null });
    });
    connection.subscribe<PoseStamped>(GOAL_POSE, { every: true }, ({ value: { header, pose } }) => {
      const { translation: [x, y], rotation } = transformOf(pose);
      this.#onGoal({ frame: header.frame_id, x, y, yaw: yawOf(rotation) });
    });
    connection.on("topics", () => this.#chooseOdometry());
    connection.on("parameters", () => this.#readOutline());
    connection.on("time", () => this.#notify());
    connection.on("nodes", () => this.#notify());
    connection.on("reset", ({ topics }) => this.#forget(topics));
    connection.on("status", ({ state }) => {
      if (state === "lost") this.#forget("all");
      this.#notify();
    });
  }

  /** Called after something changed; several changes may come in one turn. */
  onChange(callback: () => void): Dispose {
    this.#listeners.add(callback);
    return () => this.#listeners.delete(callback);
  }

  /** Whether a node subscribes to a topic, other than this page and a played recording. */
  isSubscribed(topic: string): boolean {
    return (this.connection.topics.get(topic)?.subscribers ?? []).some((node) => node !== PLAYER);
  }

  /** Where velocity commands go; undefined where nothing takes them. */
  get driveTopic(): string | undefined {
    return DRIVE.find((topic) => this.isSubscribed(topic));
  }

  get isStopped(): boolean {
    return this.stages.get("arbiter")?.message === "emergency_stop";
  }

  /** The planner's goal, else that of the topics: another planner may have no status. */
  get goal(): Goal | null {
    const planner = this.stages.get("planner");
    if (planner?.message === "canceled") return this.#sent; // the next one, if any
    const [x, y] = [parseFloat(planner?.values["goal_x"] ?? ""), parseFloat(planner?.values["goal_y"] ?? "")];
    if (!Number.isFinite(x) || !Number.isFinite(y)) return this.#goal;
    const near = this.#goal && Math.hypot(this.#goal.x - x, this.#goal.y - y) <= SAME_GOAL_M;
    return near ? this.#goal : { frame: this.#goal?.frame ?? "map", x, y, yaw: null };
  }

  /** map_T_base, or what else the fixed frame is. */
  baseIn(fixed: string): Transform | null {
    return this.baseFrame === null ? null : this.transforms.lookUp(fixed, this.baseFrame);
  }

  /** The pose of the odometry in the root of its frames, such as the map. */
  placeOfMotion(): { x: number; y: number; yawDeg: number } | null {
    const { motion, transforms } = this;
    if (!motion) return null;
    const root_T_odom = transforms.lookUp(transforms.root(motion.frame), motion.frame);
    if (!root_T_odom) return motion;
    const [x, y] = apply(root_T_odom, [motion.x, motion.y, 0]);
    return { x, y, yawDeg: wrapDeg(motion.yawDeg + (yawOf(root_T_odom.rotation) * 180) / Math.PI) };
  }

  noteSent(goal: Goal): void {
    this.#sent = this.#goal = goal;
    this.#notify();
  }

  noteCancelled(): void {
    this.#sent = this.#goal = null;
    this.#notify();
  }

  #onGoal(goal: Goal): void {
    this.#goal = goal;
    this.#notify();
  }

  #onStage(name: Stage, status: DiagnosticStatus): void {
    const { level, message } = status;
    this.stages.set(name, { level, message, values: valuesOf(status), receivedNs: this.connection.nowNs });
    if (name === "planner") this.#reportRefusal();
    this.#notify();
  }

  #reportRefusal(): void {
    const planner = this.stages.get("planner");
    const sent = this.#sent;
    if (!sent || !planner) return;
    const { goal_x, goal_y, goal_id = "", result = "" } = planner.values;
    const isThis = Math.hypot(Number(goal_x) - sent.x, Number(goal_y) - sent.y) <= SAME_GOAL_M;
    if (!isThis || goal_id === this.#reported) return;
    if (!result && planner.message !== "following") return;
    this.#reported = goal_id;
    this.#sent = null;
    if (result && result !== "reached" && result !== "canceled") this.onRefused(result);
  }

  /** Follow the best odometry that exists now. */
  #chooseOdometry(): void {
    const { topics } = this.connection;
    const type = "nav_msgs/msg/Odometry";
    const isThere = (name: string): boolean => topics.get(name)?.type === type && topics.get(name)!.isPublished;
    const topic = ODOMETRY.find(isThere) ?? [...topics.keys()].sort().find(isThere);
    if (topic === undefined || topic === this.#odometry?.topic) return;
    this.#odometry?.end();
    const end = this.connection.subscribe<Odometry>(topic, { rateHz: 20 }, ({ value }) => this.#onOdometry(value));
    this.#odometry = { topic, end };
    this.#notify();
  }

  #onOdometry({ header, child_frame_id: child, pose: { pose }, twist }: Odometry): void {
    const place = transformOf(pose);
    const { linear } = twist.twist;
    const [x, y] = place.translation;
    this.motion = {
      frame: header.frame_id,
      x,
      y,
      yawDeg: (yawOf(place.rotation) * 180) / Math.PI,
      speedMps: Math.hypot(linear.x, linear.y) * (linear.x < 0 ? -1 : 1),
      receivedMs: performance.now(),
    };
    this.#inferTransform(header.frame_id, child, place, nanosecondsOf(header.stamp));
    this.baseFrame = this.#baseOf(child);
    this.#notify();
  }

  /** Odometry is a transform too: the only one where nothing publishes /tf. */
  #inferTransform(parent: string, child: string, parent_T_child: Transform, stampNs: bigint): void {
    if (!parent || !child || parent === child) return;
    const source = "odometry";
    if ((this.transforms.links.get(child)?.source ?? source) !== source) return;
    this.transforms.set({ parent, child, parent_T_child, stampNs, source });
  }

  /** The outline is about the base; the odometry may be another frame's, such as the lidar's. */
  #baseOf(child: string): string {
    let frame: string | undefined = child;
    for (let steps = 0; frame !== undefined && steps < 20; steps++) {
      if (BASES.includes(frame)) return frame;
      frame = this.transforms.links.get(frame)?.parent;
    }
    return child;
  }

  #readOutline(): void {
    const value = this.connection.parameters.get(OUTLINE)?.value;
    if (Array.isArray(value)) this.outline = value.filter((part) => typeof part === "number");
    this.#notify();
  }

  #forget(topics: readonly string[] | "all"): void {
    const has = (topic: string): boolean => topics === "all" || topics.includes(topic);
    if (has(PLANNER_STATUS)) this.stages.delete("planner");
    if (has(CONTROL_STATUS)) this.stages.delete("control");
    if (has(COMMANDER)) this.stages.delete("arbiter");
    if (topics !== "all") return;
    this.#goal = this.#sent = this.motion = this.baseFrame = null;
    this.contacts = 0;
    this.#notify();
  }

  #notify(): void {
    for (const callback of this.#listeners) callback();
  }
}

/** The goal as a transform of its frame. */
export function placeOf({ x, y, yaw }: Goal): Transform {
  return { translation: [x, y, 0], rotation: fromYaw(yaw ?? 0) };
}

function wrapDeg(angle: number): number {
  return angle - 360 * Math.round(angle / 360);
}
