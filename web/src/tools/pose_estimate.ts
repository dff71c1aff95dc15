/** The tool that sets the robot's estimated pose. */

import { INITIAL_POSE } from "../robot/names";
import type { Goal } from "../robot/robot_state";
import { PoseTool } from "./pose_tool";

export class EstimateTool extends PoseTool {
  readonly id = "estimate";
  readonly title = "Pose estimate";
  readonly icon = "estimate";
  readonly hint = "Press where the robot is, drag to where it looks.";
  readonly key = "e";

  override get obstacle(): string {
    return this.needs(INITIAL_POSE);
  }

  protected get colour(): string {
    return this.context.theme.colour("mark");
  }

  protected send(pose: Goal): void {
    this.context.operator.sendEstimate({ ...pose, yaw: pose.yaw ?? 0 });
  }
}
