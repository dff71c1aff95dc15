/** The panel of displays: on and off, how they look, what they have or why they are empty. */

import { registerPanel } from "../panels/panel";
import type { Display, Look } from "../scene/display";
import type { Scene } from "../scene/scene";
import { h, setText } from "../ui/dom";
import { every } from "../ui/frames";
import { icon } from "../ui/icons";

export function registerDisplays(scene: Scene): void {
  registerPanel({
    id: "displays",
    title: "Displays",
    icon: "displays",
    place: "left",
    hint: "What the scene draws: on, off, colours, sizes, and why something is empty.",
    create(container) {
      const panel = new DisplaysPanel(container, scene);
      return { setVisible: (isVisible) => panel.setVisible(isVisible), dispose: () => panel.dispose() };
    },
  });
}

interface Row {
  readonly display: Display;
  readonly element: HTMLElement;
  readonly box: HTMLInputElement;
  readonly status: HTMLElement;
}

class DisplaysPanel {
  readonly #list = h("ul", { class: "displays-list" });
  readonly #ends: (() => void)[] = [];
  #rows: Row[] = [];
  #opened: string | null = null;
  #stopDrawing: (() => void) | null = null;

  constructor(
    container: HTMLElement,
    private readonly scene: Scene,
  ) {
    container.append(h("div", { class: "panel displays" }, h("div", { class: "body" }, this.#list)));
    this.#ends.push(scene.displays.onChange(() => this.#update()));
  }

  setVisible(isVisible: boolean): void {
    this.#stopDrawing?.();
    this.#stopDrawing = isVisible ? every(2, () => this.#drawStatus()) : null;
    if (isVisible) this.#update();
  }

  dispose(): void {
    this.#stopDrawing?.();
    for (const end of this.#ends) end();
  }

  #update(): void {
    const all = listOrder(this.scene.displays.all);
    if (all.length !== this.#rows.length || all.some((display, index) => display !== this.#rows[index]?.display)) {
      this.#rows = all.map((display) => this.#rows.find((row) => row.display === display) ?? this.#row(display));
      this.#list.replaceChildren(...this.#rows.map(({ element }) => element));
    }
    this.#drawStatus();
  }

  #drawStatus(): void {
    for (const { display, element, box, status } of this.#rows) {
      const { level, text } = display.status();
      box.checked = display.isVisible;
      element.dataset["level"] = level;
      setText(status, text);
    }
  }

  #row(display: Display): Row {
    const { title } = display.traits;
    const box = h("input", { type: "checkbox", onchange: () => this.#change(display, { isVisible: box.checked }) });
    const status = h("p", { class: "status" });
    const settings = h("div", { class: "settings", hidden: true });
    const more = h("button", { class: "bare", "aria-label": `Settings of ${title}`, "aria-expanded": "false", title: "Settings" }, icon("down"));
    more.addEventListener("click", () => {
      settings.hidden = !settings.hidden;
      this.#opened = settings.hidden ? null : display.id;
      more.setAttribute("aria-expanded", String(!settings.hidden));
      if (!settings.hidden) settings.replaceChildren(...this.#settings(display));
    });
    const element = h("li", {}, h("div", { class: "head" }, h("label", { class: "grow" }, box, h("span", { class: "name", title }, title)), more), status, settings);
    return { display, element, box, status };
  }

  #settings(display: Display): HTMLElement[] {
    const { traits, look } = display;
    const rows: HTMLElement[] = [];
    const field = (name: string, input: HTMLElement, value?: HTMLElement): void => void rows.push(h("label", {}, h("span", {}, name), input, value ?? null));
    if (traits.choices) {
      const select = h("select", { onchange: () => this.#change(display, { choice: select.value }) }, ...traits.choices.values.map((value) => new Option(value)));
      select.value = look.choice ?? traits.choices.values[0]!;
      field(traits.choices.label, select);
    }
    if (traits.colour !== undefined) {
      const input = h("input", { type: "color", value: look.colour ?? opaque(this.scene.theme.colour(traits.colour)), oninput: () => this.#change(display, { colour: input.value }) });
      field("Colour", input);
    }
    if (traits.size) {
      const { value, low, high, unit } = traits.size;
      field("Size", ...this.#slider(display, low, high, look.size ?? value, unit, (size) => ({ size })));
    }
    field("Opacity", ...this.#slider(display, 0, 100, Math.round(100 * look.opacity), "%", (share) => ({ opacity: share / 100 })));
    if (traits.hasDecay) field("Decay", ...this.#slider(display, 0, 60, look.decayS, "s", (decayS) => ({ decayS })));
    const reset = h("button", { onclick: () => this.#reset(display) }, icon("reset"), "Reset");
    return [...rows, reset];
  }

  #slider(display: Display, low: number, high: number, value: number, unit: string, change: (value: number) => Partial<Look>): [HTMLInputElement, HTMLElement] {
    const step = high - low <= 5 ? 0.05 : high - low <= 20 ? 0.5 : 1;
    const output = h("output", { class: "number" }, `${value} ${unit}`);
    const input = h("input", { type: "range", min: low, max: high, step, value: String(value) });
    input.addEventListener("input", () => {
      setText(output, `${Number(input.value)} ${unit}`);
      this.#change(display, change(Number(input.value)));
    });
    return [input, output];
  }

  #change(display: Display, change: Partial<Look>): void {
    this.scene.displays.change(display, change);
  }

  #reset(display: Display): void {
    this.#change(display, { colour: null, size: null, opacity: 1, decayS: 0, choice: null, isVisible: null });
    const row = this.#rows.find((each) => each.display === display);
    if (row && this.#opened === display.id) row.element.querySelector(".settings")?.replaceChildren(...this.#settings(display));
  }
}

/** The page's own displays first, then topics by name: the list keeps its order while data comes. */
function listOrder(displays: readonly Display[]): Display[] {
  const rank = (display: Display): number => (display.topic === null ? 0 : 1);
  return [...displays].sort((a, b) => rank(a) - rank(b) || (a.traits.title < b.traits.title ? -1 : 1));
}

function opaque(colour: string): string {
  return colour.slice(0, 7);
}
