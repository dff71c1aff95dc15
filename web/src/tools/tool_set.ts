/** The tools of a scene and the one that is chosen; carries gestures to it. */

import type { Dispose } from "../connection/connection";
import type { Operator } from "../robot/operator";
import { listenToPointer, type GestureTarget } from "../scene/pointer";
import type { Scene } from "../scene/scene";
import { GoalPoseTool, GoalTool } from "./goal";
import { InspectTool } from "./inspect";
import { MeasureTool } from "./measure";
import { EstimateTool } from "./pose_estimate";
import type { Tool } from "./tool";
import { routeOf, WaypointsTool } from "./waypoints";

const TURN_PER_PX = 0.008;

export class ToolSet implements GestureTarget {
  readonly inspect: InspectTool;
  readonly waypoints: WaypointsTool;
  readonly all: readonly Tool[];
  /** The place under the pointer, in the fixed frame; null outside. */
  pointer: readonly [number, number] | null = null;
  #chosen: Tool;
  readonly #listeners = new Set<() => void>();

  constructor(
    private readonly scene: Scene,
    operator: Operator,
  ) {
    const context = { scene, operator, theme: scene.theme };
    this.inspect = new InspectTool(context);
    this.waypoints = new WaypointsTool(context);
    const goal = new GoalTool(context);
    this.all = [goal, new GoalPoseTool(context), this.waypoints, new EstimateTool(context), new MeasureTool(context), this.inspect];
    this.#chosen = goal;
    scene.overlay = () => {
      const frame = scene.fixedFrame;
      const route = routeOf(operator.waypoints, scene.theme.colour("thread"), true);
      const planned = this.#chosen === this.waypoints ? [] : this.waypoints.overlay();
      return frame === null ? [] : [{ frame, primitives: [...route, ...planned, ...this.#chosen.overlay()] }];
    };
    listenToPointer(scene.element, this);
  }

  get chosen(): Tool {
    return this.#chosen;
  }

  onChange(callback: () => void): Dispose {
    this.#listeners.add(callback);
    return () => this.#listeners.delete(callback);
  }

  choose(tool: Tool): void {
    this.#chosen.cancel();
    this.#chosen = tool;
    this.#changed();
  }

  /** Drop what was begun, the planned waypoints too: they are drawn beside every tool. */
  drop(): void {
    this.#chosen.cancel();
    this.waypoints.clear();
  }

  tap(px: number, py: number, isSecondary: boolean): void {
    const place = this.scene.groundAt(px, py);
    if (!place) return;
    const tool = isSecondary ? this.inspect : this.#chosen;
    tool.tap([place[0], place[1]], px, py);
  }

  beginDrag(px: number, py: number): boolean {
    const place = this.scene.groundAt(px, py);
    return place !== null && this.#chosen.beginDrag([place[0], place[1]]);
  }

  drag(px: number, py: number): void {
    const place = this.scene.groundAt(px, py);
    if (place) this.#chosen.drag([place[0], place[1]]);
  }

  endDrag(px: number, py: number): void {
    const place = this.scene.groundAt(px, py);
    if (place) this.#chosen.endDrag([place[0], place[1]]);
    else this.#chosen.cancel();
  }

  cancelDrag(): void {
    // A measured line remains; a pose that was begun does not.
    if (this.#chosen.id !== "measure") this.#chosen.cancel();
  }

  move(fromX: number, fromY: number, toX: number, toY: number): void {
    const [from, to] = [this.scene.groundAt(fromX, fromY), this.scene.groundAt(toX, toY)];
    if (from && to) this.scene.viewing.pan(from[0] - to[0], from[1] - to[1]);
  }

  turn(dx: number, dy: number): void {
    if (this.scene.isThreeDimensional) this.scene.viewing.turn(-dx * TURN_PER_PX, dy * TURN_PER_PX);
  }

  zoom(factor: number, px: number, py: number): void {
    const place = this.scene.groundAt(px, py);
    this.scene.viewing.zoom(factor, place && [place[0], place[1]]);
  }

  hover(px: number | null, py: number | null): void {
    const place = px === null || py === null ? null : this.scene.groundAt(px, py);
    this.pointer = place && [place[0], place[1]];
    this.scene.element.classList.toggle("can-hold", this.pointer !== null && this.#chosen.canHold(this.pointer));
    this.#changed();
  }

  #changed(): void {
    for (const callback of this.#listeners) callback();
  }
}
