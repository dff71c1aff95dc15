/** The tools: inspect, goal, goal with heading, waypoints, pose estimate, measure. */

import { GOAL_POINT, GOAL_POSE, INITIAL_POSE } from "../robot/names";
import { placeOf, type Goal } from "../robot/robot_state";
import { fixed } from "../robot/text";
import type { Primitive } from "../scene/primitives";
import { fromYaw } from "../transforms/transform";
import { Tool, type Place } from "./tool";

export class InspectTool extends Tool {
  readonly id = "inspect";
  readonly title = "Inspect";
  readonly icon = "select";
  readonly hint = "Click anything to see what it is.";
  readonly key = "i";
  onInspect: (px: number, py: number) => void = () => undefined;

  tap(_place: Place, px: number, py: number): void {
    this.onInspect(px, py);
  }
}

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

/** Press for the place, drag for the heading. */
abstract class PoseTool extends Tool {
  #from: Place | null = null;
  #to: Place | null = null;

  protected abstract send(pose: Goal): void;
  protected abstract get colour(): string;

  override beginDrag(place: Place): boolean {
    this.#from = this.#to = place;
    return true;
  }

  override drag(place: Place): void {
    this.#to = place;
    this.context.scene.invalidate();
  }

  override endDrag(place: Place): void {
    const from = this.#from;
    this.cancel();
    if (from) this.#send(from, Math.atan2(place[1] - from[1], place[0] - from[0]));
  }

  tap(place: Place): void {
    this.#send(place, null);
  }

  override cancel(): void {
    this.#from = this.#to = null;
    super.cancel();
  }

  override overlay(): Primitive[] {
    const [from, to] = [this.#from, this.#to];
    if (!from || !to || (from[0] === to[0] && from[1] === to[1])) return [];
    const yaw = Math.atan2(to[1] - from[1], to[0] - from[0]);
    const pose = { translation: [from[0], from[1], 0], rotation: fromYaw(yaw) } as const;
    const degrees = `${fixed((yaw * 180) / Math.PI, 0)}°`;
    return [
      { kind: "lines", positions: Float32Array.from([from[0], from[1], 0, to[0], to[1], 0]), mode: "strip", colour: this.colour, widthPx: 1.5, isDashed: true },
      { kind: "sign", shape: "goal", pose, sizePx: 16, colour: this.colour },
      { kind: "sign", shape: "arrow", pose, sizePx: 34, colour: this.colour },
      { kind: "label", position: [to[0], to[1], 0], text: degrees, colour: this.colour, sizePx: 12 },
    ];
  }

  #send(place: Place, yaw: number | null): void {
    const { frame, context: { operator } } = this;
    if (this.obstacle) return operator.answer(this.obstacle, true);
    if (frame === null) return operator.answer("No map received yet.", true);
    this.send({ frame, x: place[0], y: place[1], yaw });
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

export class WaypointsTool extends Tool {
  readonly id = "waypoints";
  readonly title = "Waypoints";
  readonly icon = "waypoints";
  readonly hint = "Click to add waypoints, then Start.";
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
    { kind: "label", position: [goal.x, goal.y, 0], text: String(index + 1), colour, sizePx: 12 },
  ]);
  return [...line, ...marks];
}

export class MeasureTool extends Tool {
  readonly id = "measure";
  readonly title = "Measure";
  readonly icon = "measure";
  readonly hint = "Click points, or drag from one to another. Esc clears.";
  readonly key = "m";
  #points: Place[] = [];
  /** Where the pointer went down: a click adds a point, a drag is a measurement of its own. */
  #from: Place | null = null;

  tap(place: Place): void {
    this.#points.push(place);
    this.context.scene.invalidate();
  }

  override beginDrag(place: Place): boolean {
    this.#from = place;
    return true;
  }

  override drag(place: Place): void {
    if (this.#from) this.#points = [this.#from, place];
    this.context.scene.invalidate();
  }

  override endDrag(place: Place): void {
    this.drag(place);
    this.#from = null;
  }

  override cancel(): void {
    this.#points = [];
    this.#from = null;
    super.cancel();
  }

  override overlay(): Primitive[] {
    const colour = this.context.theme.colour("sea");
    const positions = Float32Array.from(this.#points.flatMap(([x, y]) => [x, y, 0]));
    const primitives: Primitive[] = this.#points.map(([x, y]) => ({
      kind: "sign", shape: "dot", pose: { translation: [x, y, 0], rotation: [0, 0, 0, 1] }, sizePx: 7, colour,
    }));
    if (this.#points.length < 2) return primitives;
    let total = 0;
    this.#points.forEach(([x, y], index) => {
      const before = this.#points[index - 1];
      if (before) total += Math.hypot(x - before[0], y - before[1]);
    });
    const [x, y] = this.#points.at(-1)!;
    return [
      { kind: "lines", positions, mode: "strip", colour, widthPx: 2 },
      ...primitives,
      { kind: "label", position: [x, y, 0], text: `${total.toFixed(2)} m`, colour, sizePx: 13 },
    ];
  }
}
