/** Keyboard shortcuts, and the dialog that lists them. */

import { takesKeys } from "../tools/teleop";
import { h } from "../ui/dom";
import { icon } from "../ui/icons";

export interface Shortcut {
  /** `KeyboardEvent.key` in lower case. */
  readonly key: string;
  readonly text: string;
  readonly act: () => void;
}

/** Listed only: other parts handle them. */
const OTHERS: readonly (readonly [string, string])[] = [
  ["Space", "Emergency stop; with a recording: play, pause"],
  ["↑ ↓ ← →", "Drive while held"],
  ["Drag", "Move the view; with a pose tool: the heading"],
  ["Right drag, Ctrl drag", "Turn the view in 3D"],
  ["Wheel, pinch", "Zoom"],
  ["Right click, long press", "What is here"],
  ["Tab · ← · →", "Between controls; between tabs of panels"],
];

export class Shortcuts {
  readonly dialog: HTMLDialogElement;
  readonly #all: readonly Shortcut[];

  constructor(shortcuts: readonly Shortcut[]) {
    this.#all = [...shortcuts, { key: "?", text: "This list", act: () => this.show() }];
    const row = (keys: string, text: string): HTMLElement[] => [h("dt", {}, ...keys.split(" · ").map((key) => h("kbd", {}, key))), h("dd", {}, text)];
    const close = h("button", { class: "bare", "aria-label": "Close", onclick: () => this.dialog.close() }, icon("close"));
    this.dialog = h(
      "dialog",
      { class: "help-dialog", "aria-labelledby": "help-title" },
      h("div", { class: "row" }, h("h2", { id: "help-title", class: "grow" }, "Keyboard and mouse"), close),
      h("dl", {}, ...OTHERS.flatMap(([keys, text]) => row(keys, text)), ...this.#all.flatMap(({ key, text }) => row(key === "escape" ? "Esc" : key.toUpperCase(), text))),
    );
    addEventListener("keydown", (event) => this.#onKey(event));
  }

  show(): void {
    if (!this.dialog.open) this.dialog.showModal();
  }

  #onKey(event: KeyboardEvent): void {
    if (takesKeys(event.target) || event.ctrlKey || event.metaKey || event.altKey || document.querySelector("dialog[open]")) return;
    const found = this.#all.find(({ key }) => key === event.key.toLowerCase());
    if (!found) return;
    event.preventDefault();
    found.act();
  }
}
