/** What lies under a press: a card beside it, with what can be done there. */

import type { Operator } from "../robot/operator";
import { fixed } from "../robot/text";
import type { Scene } from "../scene/scene";
import { apply } from "../transforms/transform";
import { h } from "../ui/dom";
import { icon } from "../ui/icons";

const MOST = 5;
/** Pixels to the edges of the scene and to what stays free, and from the press. */
const MARGIN = 8;
const BESIDE = 16;

export class InfoCard {
  readonly #card = h("div", { class: "info-card", role: "dialog", "aria-label": "What is here", tabindex: "-1", hidden: true });

  constructor(
    private readonly scene: Scene,
    private readonly operator: Operator,
    private readonly parent: HTMLElement,
    /** What the card does not cover: Stop and its neighbours. */
    private readonly free: HTMLElement,
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
      h(
        "div",
        { class: "row" },
        act("Drive here", "/goal_point", () => this.operator.sendGoal({ frame, x, y, yaw: null })),
        act("Robot is here", "/initialpose", () => this.operator.sendEstimate({ frame, x, y, yaw: 0 })),
      ),
      ...this.#found(px, py),
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
      const { frame } = item.part;
      const [x, y, z] = apply(item.fixed_T_part, hit.point);
      const rows = [...facts];
      const isKnown = frame === this.scene.fixedFrame || facts.some(([, value]) => value === frame);
      if (!isKnown) rows.push(["frame", frame]);
      if (!facts.some(([name]) => name === "position")) rows.push(["position", `${fixed(x, 2)}, ${fixed(y, 2)}, ${fixed(z, 2)} m`]);
      entries.push(
        h("section", {}, h("h3", {}, display.traits.title), h("dl", {}, ...rows.flatMap(([name, value]) => [h("dt", {}, name), h("dd", { class: "number" }, value)]))),
      );
      if (entries.length === MOST) break;
    }
    return entries.length > 0 ? entries : [h("p", { class: "hint" }, "Nothing is drawn here.")];
  }

  #place(px: number, py: number): void {
    const size = ({ offsetWidth, offsetHeight }: HTMLElement): Size => ({ width: offsetWidth, height: offsetHeight });
    const free = { left: this.free.offsetLeft, top: this.free.offsetTop, ...size(this.free) };
    const { left, top } = cardPlace([px, py], size(this.#card), size(this.parent), free);
    Object.assign(this.#card.style, { left: `${left}px`, top: `${top}px` });
  }
}

interface Place {
  readonly left: number;
  readonly top: number;
}

/** Of a card, the scene or what stays free in a corner of it; in pixels. */
interface Size {
  readonly width: number;
  readonly height: number;
}

/** A card beside a press: within the scene and off the area, which Stop is in. */
export function cardPlace([px, py]: readonly [number, number], card: Size, scene: Size, free: Place & Size): Place {
  const within = (left: number, top: number): Place => ({
    left: Math.max(MARGIN, Math.min(scene.width - card.width - MARGIN, left)),
    top: Math.max(MARGIN, Math.min(scene.height - card.height - MARGIN, top)),
  });
  const isFree = ({ left, top }: Place): boolean =>
    left + card.width <= free.left || free.left + free.width <= left || top + card.height <= free.top || free.top + free.height <= top;
  const beside = px + BESIDE + card.width <= scene.width ? px + BESIDE : px - card.width - BESIDE;
  const level = py - 20;
  const places = [within(beside, level), within(beside, free.top - card.height - MARGIN), within(free.left - card.width - MARGIN, level)];
  return places.find(isFree) ?? places[0]!;
}
