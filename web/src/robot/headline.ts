/** The headline: what the robot does, or what is wrong, by priority. */

import type { Connection, NodeReport } from "../connection/connection";
import type { Goal, RobotState, Stage, StageStatus } from "./robot_state";
import { ageText, fixed, words } from "./text";

/** Planner and control publish their status at 2 Hz at least. */
const SILENT_S = 2;
/** Reports on nodes come every half second. */
const MUTE_S = 2.5;
/** Topics needed to drive: the loss of a publisher of one of them is shown at once. */
const DUTIES = ["/cmd_vel_nav", "/cmd_vel", "/path", "/map", "/costmap", "/odom/filtered", "/odom", "/lidar", "/scan"];

export interface Headline {
  readonly text: string;
  readonly detail: string;
  readonly isBad: boolean;
}

/** Which topics a node published, kept when it is gone. */
export class Duties {
  readonly #duties = new Map<string, Set<string>>();

  note(connection: Connection): void {
    for (const topic of DUTIES) {
      for (const node of connection.topics.get(topic)?.publishers ?? []) {
        this.#duties.set(node, (this.#duties.get(node) ?? new Set()).add(topic));
      }
    }
  }

  clear(): void {
    this.#duties.clear();
  }

  /** A node that only teleoperates may leave; one that is silent may not. */
  isNeeded({ name, state }: NodeReport): boolean {
    return [...(this.#duties.get(name) ?? [])].some((topic) => state === "silent" || topic !== "/cmd_vel");
  }
}

export function headlineOf(robot: RobotState, duties: Duties): Headline {
  const { connection, stages } = robot;
  const lost = connectionProblem(connection);
  if (lost) return lost;
  const missed = missedNodes(connection.nodes, (report) => duties.isNeeded(report) || stages.has(report.name.slice(1) as Stage));
  const needed = missed.filter((report) => report.isNeeded);
  const problem = nodeProblem(needed);
  if (problem) return { text: problem[0], detail: `${problem[1]} ${stopText(robot, needed.length > 1)}`, isBad: true };
  const silence = silentStages(robot);
  if (silence) return silence;
  const arbiter = stages.get("arbiter");
  if (arbiter?.message === "emergency_stop") {
    return { text: "Emergency stop", detail: "The robot obeys no command until the stop is released.", isBad: true };
  }
  if (arbiter?.values["masked_topics"]?.includes("/cmd_vel_nav")) {
    const parts = ["Navigation waits with its goal", ...details(robot)];
    const text = arbiter.message === "pause" ? "Paused" : `Driven by ${uncapitalised(commanderText(arbiter))}`;
    return { text, detail: parts.join(" · "), isBad: false };
  }
  const others = missed.map(({ name, since }) => `${name} has not responded for ${ageText(since)}`);
  const recording = recordingText(connection);
  const first = firstStage(stages);
  if (first) {
    const parts = [...(recording ? [recording] : []), ...details(robot), ...others];
    return { text: statusText(first, robot.goal), detail: parts.join(" · "), isBad: false };
  }
  const text = recording ?? (connection.topics.size > 0 ? "Running" : "Waiting for the robot");
  return { text, detail: [`${connection.topics.size} topics`, ...others].join(" · "), isBad: false };
}

function connectionProblem(connection: Connection): Headline | null {
  const { status, silenceS, blockedS } = connection;
  if (status.state === "connecting") return { text: "Connecting", detail: status.reason || "Preparing the live view…", isBad: false };
  if (status.state === "lost") {
    return { text: "Not connected", detail: status.reason || "Check that the program is running. This page reconnects by itself.", isBad: false };
  }
  if (silenceS > MUTE_S) {
    const detail = `Its program has been stopped or disconnected for ${ageText(silenceS)}. The data shown here is that old.`;
    return { text: "The live view does not respond", detail, isBad: true };
  }
  if (blockedS > 0) {
    const detail = `A callback has been running for ${ageText(blockedS)}; the nodes of this program wait for it.`;
    return { text: "The program is blocked", detail, isBad: true };
  }
  return null;
}

interface Missed extends NodeReport {
  readonly isNeeded: boolean;
}

/** Missing nodes, needed ones first. */
function missedNodes(reports: readonly NodeReport[], isNeeded: (report: NodeReport) => boolean): Missed[] {
  return reports
    .filter(({ state }) => state === "silent" || state === "gone")
    .map((report) => ({ ...report, isNeeded: isNeeded(report) }))
    .filter((report) => report.isNeeded || report.state === "silent")
    .sort((a, b) => Number(b.isNeeded) - Number(a.isNeeded));
}

function silentStages(robot: RobotState): Headline | null {
  const { connection, stages } = robot;
  const ageS = (status: StageStatus): number => Number(connection.nowNs - status.receivedNs) / 1e9;
  if (connection.playback) return null;
  const silent = [...stages].filter(([name, status]) => name !== "arbiter" && ageS(status) > SILENT_S);
  const [first] = silent;
  if (!first) return null;
  const names = words(silent.map(([name]) => name).join(" and "));
  const text = `${names} ${silent.length > 1 ? "have" : "has"} stopped responding`;
  const detail = `No status for ${ageText(ageS(first[1]))}. ${stopText(robot, silent.length > 1)}`;
  return { text, detail, isBad: true };
}

/** Whether the robot has stopped. */
function stopText({ connection, motion }: Pick<RobotState, "connection" | "motion">, isMany: boolean): string {
  if (connection.playback || !motion) return "";
  const ageS = (performance.now() - motion.receivedMs) / 1000;
  if (ageS > 1.5) return `No odometry for ${ageText(ageS)}.`;
  const speed = Math.abs(motion.speedMps);
  return speed < 0.03 ? `The robot stops until the ${isMany ? "nodes are" : "node is"} back.` : `The robot still moves at ${fixed(speed, 1)} m/s.`;
}

function firstStage(stages: ReadonlyMap<Stage, StageStatus>): StageStatus | undefined {
  const drive = [stages.get("planner"), stages.get("control")].filter((status) => status !== undefined);
  return drive.sort((a, b) => b.level - a.level)[0];
}

/** What the stage does, with its goal; another planner may name none. */
function statusText({ message, values }: StageStatus, goal: Goal | null): string {
  if (message === "waiting_for_goal") return "Waiting for a goal";
  const verb = { following: "Driving to", reached: "Reached", planning: "Planning to" }[message];
  const stated = { x: Number(values["goal_x"]), y: Number(values["goal_y"]) };
  const place = Number.isFinite(stated.x) && Number.isFinite(stated.y) ? stated : goal;
  return verb && place ? `${verb} ${fixed(place.x, 1)}, ${fixed(place.y, 1)}` : words(message);
}

function details({ stages }: RobotState): string[] {
  const [planner, control] = [stages.get("planner"), stages.get("control")];
  const left = parseFloat(planner?.values["distance_left_m"] ?? "");
  const goes = Number.isFinite(parseFloat(planner?.values["goal_x"] ?? "")) && !["reached", "canceled"].includes(planner?.message ?? "");
  const parts = goes && Number.isFinite(left) ? [`${fixed(left, 1)} m to go`] : [];
  if (planner) parts.push(`planner: ${words(planner.message).toLowerCase()}`);
  if (control) parts.push(`control: ${words(control.message).toLowerCase()}`);
  return parts.map((part, index) => (index === 0 ? words(part) : part));
}

export function recordingText({ playback }: Connection): string | null {
  if (!playback) return null;
  const texts = { playing: "Playing a recording", paused: "Recording, paused", buffering: "Recording, loading", ended: "Recording, ended" };
  return texts[playback.status];
}

/** "Operator (viewer)", "Navigation", "Emergency stop". */
export function commanderText({ message, values }: Pick<StageStatus, "message" | "values">): string {
  const from = values["nodes"]?.replaceAll("/", "").replaceAll(",", ", ");
  return words(message) + (message !== "navigation" && from ? ` (${from})` : "");
}

function uncapitalised(text: string): string {
  return text.charAt(0).toLowerCase() + text.slice(1);
}

/** "Control", "Control and planner", "4 nodes". */
function namesText(reports: readonly NodeReport[]): string {
  const names = reports.map(({ name }) => name.slice(name.lastIndexOf("/") + 1));
  return words(names.length > 3 ? `${names.length} nodes` : names.join(", ").replace(/, ([^,]*)$/, " and $1"));
}

/** Headline and detail of missing nodes; null without a problem. */
export function nodeProblem(reports: readonly NodeReport[]): [string, string] | null {
  if (reports.length === 0) return null;
  const states = new Set(reports.map(({ state }) => state));
  const isMany = reports.length > 1;
  const longest = ageText(Math.max(...reports.map(({ since }) => since)));
  if (states.size > 1) return [`${namesText(reports)} are missing`, `Gone or not responding for ${longest}.`];
  if (states.has("gone")) return [`${namesText(reports)} ${isMany ? "are" : "is"} gone`, `Ended or disconnected ${longest} ago.`];
  return [`${namesText(reports)} ${isMany ? "do" : "does"} not respond`, `Stopped, blocked or disconnected for ${longest}.`];
}
