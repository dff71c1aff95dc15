/** The tools that make a click a goal, without and with a heading. */

import { GOAL_POINT, GOAL_POSE } from "../robot/names";
import { placeOf, type Goal } from "../robot/robot_state";
import type { Primitive } from "../scene/primitives";
import { compose, yawOf } from "../transforms/transform";
import { PoseTool } from "./pose_tool";
import { Tool, type Place } from "./tool";

/** How near to the mark of the goal a drag takes hold of it. */
const HOLD_PX = 14;

export class GoalTool extends Tool {
  readonly id = "goal";
  readonly title = "Goal";
  readonly icon = "goal";
  readonly key = "g";
  /** Where the goal is dragged to. */
  #moved: Goal | null = null;

  get hint(): string {
    const click = this.context.scene.robot.isStopped ? "Click to set the goal" : "Click to send the robot there";
    return `${click}; drag the goal to move it.`;
  }

  override get obstacle(): string {
    return this.needs(GOAL_POINT);
  }

  tap([x, y]: Place): void {
    this.#send({ x, y, yaw: null });
  }

  override canHold(place: Place): boolean {
    return this.obstacle === "" && this.#goalAt(place) !== null;
  }

  override beginDrag(place: Place): boolean {
    this.#moved = this.obstacle === "" ? this.#goalAt(place) : null;
    return this.#moved !== null;
  }

  override drag([x, y]: Place): void {
    if (this.#moved) this.#moved = { ...this.#moved, x, y };
    this.context.scene.invalidate();
  }

  override endDrag(place: Place): void {
    this.drag(place);
    const goal = this.#moved;
    this.cancel();
    if (goal) this.#send(goal);
  }

  override cancel(): void {
    this.#moved = null;
    super.cancel();
  }

  override overlay(): Primitive[] {
    if (!this.#moved) return [];
    const [pose, colour] = [placeOf(this.#moved), this.context.theme.colour("thread")];
    const sign = { kind: "sign", shape: "goal", pose, sizePx: 22, colour } as const;
    return this.#moved.yaw === null ? [sign] : [sign, { kind: "sign", shape: "arrow", pose, sizePx: 34, colour }];
  }

  /** The goal that the robot drives to, in the fixed frame, if its mark is at a place. */
  #goalAt([x, y]: Place): Goal | null {
    const { scene } = this.context;
    const { frame } = this;
    const goal = scene.robot.goal;
    const fixed_T_goal = goal && frame !== null ? scene.transforms.lookUp(frame, goal.frame) : null;
    if (!goal || !fixed_T_goal || frame === null || !scene.displays.goal.isVisible) return null;
    const pose = compose(fixed_T_goal, placeOf(goal));
    const [gx, gy] = pose.translation;
    if (Math.hypot(gx - x, gy - y) * scene.viewing.viewpoint.scale > HOLD_PX) return null;
    return { frame, x: gx, y: gy, yaw: goal.yaw === null ? null : yawOf(pose.rotation) };
  }

  #send(goal: Omit<Goal, "frame">): void {
    const { frame, context: { operator } } = this;
    if (this.obstacle) return operator.answer(this.obstacle, true);
    if (frame === null) return operator.answer("No map received yet.", true);
    operator.sendGoal({ ...goal, frame });
  }
}

export class GoalPoseTool extends PoseTool {
  readonly id = "pose";
  readonly title = "Goal with heading";
  readonly icon = "pose";
  readonly hint = "Press where to go, drag to where the robot is to look.";
  readonly key = "h";

  override get obstacle(): string {
    return this.needs(GOAL_POSE);
  }

  protected get colour(): string {
    return this.context.theme.colour("thread");
  }

  protected send(pose: Goal): void {
    this.context.operator.sendGoal(pose);
  }
}
