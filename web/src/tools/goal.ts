/** The tools that make a click a goal, without and with a heading. */

import { GOAL_POINT, GOAL_POSE } from "../robot/names";
import type { Goal } from "../robot/robot_state";
import { PoseTool } from "./pose_tool";
import { Tool, type Place } from "./tool";

export class GoalTool extends Tool {
  readonly id = "goal";
  readonly title = "Goal";
  readonly icon = "goal";
  readonly hint = "Click to send the robot there.";
  readonly key = "g";

  override get obstacle(): string {
    return this.needs(GOAL_POINT);
  }

  tap([x, y]: Place): void {
    const { frame, context: { operator } } = this;
    if (this.obstacle) return operator.answer(this.obstacle, true);
    if (frame === null) return operator.answer("No map received yet.", true);
    operator.sendGoal({ frame, x, y, yaw: null });
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
