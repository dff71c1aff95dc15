/** What lies under a press: a card beside it, with what can be done there. */

import type { Operator } from "../robot/operator";
import { fixed } from "../robot/text";
import type { Scene } from "../scene/scene";
import { apply } from "../transforms/transform";
import { h } from "../ui/dom";
import { icon } from "../ui/icons";

const MOST = 5;

export class InfoCard {
  readonly #card = h("div", { class: "info-card", role: "dialog", "aria-label": "What is here", tabindex: "-1", hidden: true });

  constructor(
    private readonly scene: Scene,
    private readonly operator: Operator,
    private readonly parent: HTMLElement,
  ) {
    parent.append(this.#card);
    this.#card.addEventListener("keydown", (event) => {
      if (event.key === "Escape") this.hide();
    });
    scene.element.addEventListener("pointerdown", () => this.hide());
  }

  show(px: number, py: number): void {
    const place = this.scene.groundAt(px, py);
    const { fixedFrame: frame } = this.scene;
    if (!place || frame === null) return;
    const [x, y] = place;
    const { robot } = this.operator;
    const act = (text: string, topic: string, send: () => void): HTMLElement | null =>
      robot.isSubscribed(topic) ? h("button", { onclick: () => { send(); this.hide(); } }, text) : null;
    const base = robot.baseIn(frame);
    const away = base ? ` · ${Math.hypot(x - base.translation[0], y - base.translation[1]).toFixed(2)} m from the robot` : "";
    this.#card.replaceChildren(
      h("div", { class: "row" }, h("strong", { class: "number grow" }, `${fixed(x, 2)}, ${fixed(y, 2)} m`), h("button", { class: "bare", "aria-label": "Close", onclick: () => this.hide() }, icon("close"))),
      h("p", { class: "hint" }, `in ${frame}${away}`),
      ...this.#found(px, py),
      h(
        "div",
        { class: "row" },
        act("Drive here", "/goal_point", () => this.operator.sendGoal({ frame, x, y, yaw: null })),
        act("Robot is here", "/initialpose", () => this.operator.sendEstimate({ frame, x, y, yaw: 0 })),
      ),
    );
    this.#card.hidden = false;
    this.#place(px, py);
    this.#card.focus({ preventScroll: true });
  }

  hide(): void {
    this.#card.hidden = true;
  }

  #found(px: number, py: number): HTMLElement[] {
    const { displays } = this.scene;
    const seen = new Set<string>();
    const entries: HTMLElement[] = [];
    for (const { item, primitive, hit } of this.scene.pick(px, py)) {
      const display = displays.all.find((each) => each.parts().includes(item.part));
      if (!display || display === displays.grid || seen.has(display.id)) continue;
      seen.add(display.id);
      const facts = item.part.about?.(primitive, hit) ?? [];
      const [x, y, z] = apply(item.fixed_T_part, hit.point);
      const rows = [...facts, ["frame", item.part.frame] as const, ["position", `${fixed(x, 2)}, ${fixed(y, 2)}, ${fixed(z, 2)} m`] as const];
      entries.push(
        h("section", {}, h("h3", {}, display.traits.title), h("dl", {}, ...rows.flatMap(([name, value]) => [h("dt", {}, name), h("dd", { class: "number" }, value)]))),
      );
      if (entries.length === MOST) break;
    }
    return entries.length > 0 ? entries : [h("p", { class: "hint" }, "Nothing is drawn here.")];
  }

  #place(px: number, py: number): void {
    const { clientWidth: width, clientHeight: height } = this.parent;
    const { offsetWidth: w, offsetHeight: hh } = this.#card;
    this.#card.style.left = `${Math.max(8, px + 16 + w < width ? px + 16 : px - w - 16)}px`;
    this.#card.style.top = `${Math.max(8, Math.min(py - 20, height - hh - 8))}px`;
  }
}
