/** The tool that opens the card of what is clicked. */

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
