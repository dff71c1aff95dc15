/** The tool that plans a list of waypoints. */

import { GOAL_POINT } from "../robot/names";
import { placeOf, type Goal } from "../robot/robot_state";
import type { Primitive } from "../scene/primitives";
import { Tool, type Place } from "./tool";

export class WaypointsTool extends Tool {
  readonly id = "waypoints";
  readonly title = "Waypoints";
  readonly icon = "waypoints";
  readonly hint = "Click to add waypoints, then Start. Esc clears.";
  readonly key = "w";
  /** Planned, not yet sent. */
  readonly planned: Goal[] = [];
  onChange: () => void = () => undefined;

  override get obstacle(): string {
    return this.needs(GOAL_POINT);
  }

  tap([x, y]: Place): void {
    const { frame, context: { operator } } = this;
    if (frame === null) return operator.answer("No map received yet.", true);
    this.planned.push({ frame, x, y, yaw: null });
    this.#changed();
  }

  remove(index: number): void {
    this.planned.splice(index, 1);
    this.#changed();
  }

  clear(): void {
    this.planned.length = 0;
    this.#changed();
  }

  start(): void {
    const { operator } = this.context;
    if (this.obstacle) return operator.answer(this.obstacle, true);
    operator.sendWaypoints(this.planned);
    this.clear();
  }

  override overlay(): Primitive[] {
    return routeOf(this.planned, this.context.theme.colour("mark"), true);
  }

  #changed(): void {
    this.onChange();
    this.context.scene.invalidate();
  }
}

/** Places in order, joined by a line. */
export function routeOf(goals: readonly Goal[], colour: string, isDashed: boolean): Primitive[] {
  const positions = Float32Array.from(goals.flatMap(({ x, y }) => [x, y, 0]));
  const line: Primitive[] = goals.length > 1 ? [{ kind: "lines", positions, mode: "strip", colour, widthPx: 1.5, isDashed }] : [];
  const marks = goals.flatMap((goal, index): Primitive[] => [
    { kind: "sign", shape: "ring", pose: placeOf(goal), sizePx: 12, colour },
    { kind: "label", position: [goal.x, goal.y, 0], text: String(index + 1), colour, sizePx: 12, abovePx: 10 },
  ]);
  return [...line, ...marks];
}
