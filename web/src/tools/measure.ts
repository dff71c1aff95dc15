/** The tool that measures distances on the map. */

import type { Primitive } from "../scene/primitives";
import { Tool, type Place } from "./tool";

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
