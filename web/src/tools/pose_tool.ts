/** A tool that chooses a pose on the map. */

import type { Goal } from "../robot/robot_state";
import { fixed } from "../robot/text";
import type { Primitive } from "../scene/primitives";
import { fromYaw } from "../transforms/transform";
import { Tool, type Place } from "./tool";

/** Press for the place, drag for the heading. */
export abstract class PoseTool extends Tool {
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
