/** Keyboard shortcuts, and the card that lists them. */

import { takesKeys } from "../tools/teleop";
import { h } from "../ui/dom";
import { icon } from "../ui/icons";
import { popover, type Popover } from "./popover";

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
  ["Right drag · Ctrl drag", "Turn the view in 3D"],
  ["Wheel · Pinch", "Zoom"],
  ["Right click · Long press", "What is here"],
  ["Tab · ← · →", "Between controls; between tabs of panels"],
];

const TITLE = "Keyboard and mouse";

export class Shortcuts {
  readonly list: Popover;
  readonly #all: readonly Shortcut[];

  constructor(shortcuts: readonly Shortcut[]) {
    this.#all = [...shortcuts, { key: "?", text: "This list", act: () => this.list.card.showPopover() }];
    this.list = popover("Shortcuts", "help", (close) => this.#content(close));
    this.list.button.title = "Shortcuts (?)";
    this.list.card.classList.add("shortcuts");
    this.list.card.role = "dialog";
    this.list.card.ariaLabel = TITLE;
    addEventListener("keydown", (event) => this.#onKey(event));
  }

  #content(close: () => void): readonly Node[] {
    const row = (keys: string, text: string): HTMLElement[] => [h("dt", {}, ...keys.split(" · ").map((key) => h("kbd", {}, key))), h("dd", {}, text)];
    return [
      h("div", { class: "row" }, h("h2", { class: "grow" }, TITLE), h("button", { class: "bare", "aria-label": "Close", autofocus: true, onclick: close }, icon("close"))),
      h("dl", {}, ...OTHERS.flatMap(([keys, text]) => row(keys, text)), ...this.#all.flatMap(({ key, text }) => row(key === "escape" ? "Esc" : key.toUpperCase(), text))),
    ];
  }

  #onKey(event: KeyboardEvent): void {
    if (takesKeys(event.target) || event.ctrlKey || event.metaKey || event.altKey) return;
    if (document.querySelector("dialog[open], :popover-open")) return; // Escape closes it
    const found = this.#all.find(({ key }) => key === event.key.toLowerCase());
    if (!found) return;
    event.preventDefault();
    found.act();
  }
}
