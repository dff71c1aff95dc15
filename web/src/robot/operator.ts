/** Commands of the person at this page. Every method publishes before it returns. */

import { poseOf, type Header } from "../scene/messages";
import { stampOf } from "../transforms/stamp";
import { CANCEL_GOAL, GOAL_POINT, GOAL_POSE, INITIAL_POSE, PAUSE, RELEASE, STOP } from "./names";
import { placeOf, type Goal, type RobotState } from "./robot_state";
import { fixed, words } from "./text";

/** ms between two velocity commands; the arbiter forgets one after half a second. */
const PERIOD_MS = 100;
/** Every PERIOD_MS, until the arbiter confirms the stop. */
const STOP_REPEATS = 20;

/** A result for the person: shown beside the scene. */
export type Answer = (text: string, isBad?: boolean) => void;

export class Operator {
  #stopping: ReturnType<typeof setInterval> | undefined;
  #driving: ReturnType<typeof setInterval> | undefined;
  /** The velocity command that is repeated: m/s, rad/s. */
  #command: readonly [number, number] = [0, 0];
  #waypoints: { frame: string; left: Goal[]; total: number } | null = null;
  isPaused = false;

  constructor(
    readonly robot: RobotState,
    readonly answer: Answer,
  ) {
    robot.onRefused = (reason) => {
      this.#waypoints = null;
      answer(`Goal refused: ${words(reason).toLowerCase()}.`, true);
    };
    robot.onChange(() => this.#followWaypoints());
  }

  /** Waypoints that are still ahead, the present one first. */
  get waypoints(): readonly Goal[] {
    return this.#waypoints?.left ?? [];
  }

  sendGoal(goal: Goal): void {
    this.#waypoints = null;
    this.#send(goal);
  }

  sendWaypoints(goals: readonly Goal[]): void {
    const [first] = goals;
    if (!first) return;
    this.#waypoints = { frame: first.frame, left: [...goals], total: goals.length };
    this.#send(first);
  }

  #send(goal: Goal): void {
    const { robot } = this;
    const isPose = goal.yaw !== null;
    const topic = isPose ? GOAL_POSE : GOAL_POINT;
    if (!this.#isLive()) return;
    if (!robot.isSubscribed(topic)) return this.answer(`No node subscribes to ${topic}.`, true);
    const header = this.#header(goal.frame);
    if (isPose) robot.connection.publish(topic, "geometry_msgs/msg/PoseStamped", { header, pose: poseOf(placeOf(goal)) });
    else robot.connection.publish(topic, "geometry_msgs/msg/PointStamped", { header, point: { x: goal.x, y: goal.y, z: 0 } });
    robot.noteSent(goal);
    const heading = goal.yaw === null ? "" : `, heading ${fixed((goal.yaw * 180) / Math.PI, 0)}°,`;
    const of = this.#waypoints ? `Waypoint ${this.#waypoints.total - this.#waypoints.left.length + 1} of ${this.#waypoints.total}` : "Goal";
    this.answer(`${of} ${fixed(goal.x, 1)}, ${fixed(goal.y, 1)}${heading} sent.`);
  }

  /** The next waypoint, when the planner has reached the present one. */
  #followWaypoints(): void {
    const [present, next] = this.#waypoints?.left ?? [];
    const planner = this.robot.stages.get("planner");
    if (!present || planner?.message !== "reached") return;
    const [x, y] = [Number(planner.values["goal_x"]), Number(planner.values["goal_y"])];
    if (Math.hypot(x - present.x, y - present.y) > 0.06) return;
    this.#waypoints?.left.shift();
    if (next) this.#send(next);
    else {
      this.#waypoints = null;
      this.answer("All waypoints reached.");
    }
  }

  sendEstimate(pose: Goal): void {
    if (!this.#isLive()) return;
    const covariance = Array.from({ length: 36 }, () => 0);
    covariance[0] = covariance[7] = 0.25;
    covariance[35] = 0.0685; // 15°
    const message = { header: this.#header(pose.frame), pose: { pose: poseOf(placeOf(pose)), covariance } };
    this.robot.connection.publish(INITIAL_POSE, "geometry_msgs/msg/PoseWithCovarianceStamped", message);
    this.answer(`Pose estimate ${fixed(pose.x, 1)}, ${fixed(pose.y, 1)} sent.`);
  }

  cancel(): void {
    this.#waypoints = null;
    if (!this.#isLive()) return;
    this.robot.connection.publish(CANCEL_GOAL, "std_msgs/msg/Empty", {});
    this.robot.noteCancelled();
    this.answer("Goal cancelled.");
  }

  pause(isPaused: boolean): void {
    if (!this.#isLive()) return;
    this.robot.connection.publish(PAUSE, "std_msgs/msg/Bool", { data: isPaused });
    this.isPaused = isPaused;
    this.answer(isPaused ? "Navigation paused: the robot stops and keeps its goal." : "Navigation resumed.");
  }

  /** Drive with this velocity from now until another; zero ends it. */
  drive(linearMps: number, angularRadps: number): void {
    this.#command = [linearMps, angularRadps];
    this.#publishDrive();
    const isMoving = linearMps !== 0 || angularRadps !== 0;
    if (isMoving && this.robot.isStopped) this.answer("The emergency stop holds the robot: release it to drive.", true);
    if (isMoving) this.#driving ??= setInterval(() => this.#publishDrive(), PERIOD_MS);
    else {
      clearInterval(this.#driving);
      this.#driving = undefined;
    }
  }

  get isDriving(): boolean {
    return this.#driving !== undefined;
  }

  #publishDrive(): void {
    const topic = this.robot.driveTopic;
    if (topic === undefined) return;
    const [x, z] = this.#command;
    this.robot.connection.publish(topic, "geometry_msgs/msg/Twist", {
      linear: { x, y: 0, z: 0 },
      angular: { x: 0, y: 0, z },
    });
  }

  stop(): void {
    if (this.isDriving) this.drive(0, 0);
    clearInterval(this.#stopping);
    if (!this.#publishStop()) return this.answer("Not connected: this page cannot stop the robot.", true);
    this.answer(""); // of what was sent before
    let left = STOP_REPEATS;
    this.#stopping = setInterval(() => {
      if (left-- > 0 && !this.robot.isStopped) this.#publishStop();
      else clearInterval(this.#stopping);
    }, PERIOD_MS);
  }

  release(): void {
    clearInterval(this.#stopping);
    if (this.#isLive()) this.robot.connection.publish(RELEASE, "std_msgs/msg/Empty", {});
  }

  #publishStop(): boolean {
    return this.robot.connection.publish(STOP, "std_msgs/msg/Bool", { data: true });
  }

  #isLive(): boolean {
    const isLive = this.robot.connection.status.state === "live";
    if (!isLive) this.answer("Not connected.", true);
    return isLive;
  }

  #header(frame: string): Header {
    return { stamp: stampOf(this.robot.connection.nowNs), frame_id: frame };
  }
}
