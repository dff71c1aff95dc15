/** The tree of frames: parents and children, their newest transform, its age and rate. */

import { fixed } from "../robot/text";
import { yawOf } from "../transforms/transform";
import type { Link } from "../transforms/link_history";
import { h, setText } from "../ui/dom";
import { every } from "../ui/frames";
import { emptyState } from "./empty";
import { registerPanel, type PanelContext, type PanelInstance } from "./panel";
import "./frames.css";

interface Row {
  readonly age: HTMLElement;
  readonly place: HTMLElement;
}

class FramesPanel implements PanelInstance {
  readonly #list = h("ul", { class: "frames-tree" });
  readonly #empty = emptyState("frames", "No frames yet", "No node has published on /tf or /tf_static.");
  readonly #rows = new Map<string, Row>();
  readonly #end: () => void;
  #stop: (() => void) | null = null;

  constructor(
    container: HTMLElement,
    private readonly context: PanelContext,
  ) {
    container.append(h("div", { class: "panel frames" }, h("div", { class: "body", tabindex: "0", role: "region", "aria-label": "Frames" }, this.#list, this.#empty.element)));
    this.#end = context.transforms.onStructure(() => {
      if (this.#stop) this.#build();
    });
  }

  setVisible(isVisible: boolean): void {
    this.#stop?.();
    this.#stop = isVisible ? every(2, () => this.#draw()) : null;
    if (isVisible) this.#build();
  }

  dispose(): void {
    this.#stop?.();
    this.#end();
  }

  #build(): void {
    const { links, frames } = this.context.transforms;
    this.#rows.clear();
    const children = new Map<string, string[]>();
    for (const frame of frames) {
      const parent = links.get(frame)?.parent ?? "";
      children.set(parent, [...(children.get(parent) ?? []), frame]);
    }
    this.#list.replaceChildren(...this.#branch("", children, new Set()));
    this.#list.hidden = frames.length === 0;
    this.#empty.element.hidden = frames.length > 0;
    this.#draw();
  }

  #branch(parent: string, children: ReadonlyMap<string, string[]>, seen: Set<string>): HTMLElement[] {
    return (children.get(parent) ?? []).filter((frame) => !seen.has(frame)).map((frame) => {
      seen.add(frame);
      const [age, place] = [h("span", { class: "frames-age number", title: "Age of the newest transform" }), h("small", { class: "frames-place number" })];
      this.#rows.set(frame, { age, place });
      const below = this.#branch(frame, children, seen);
      return h("li", {}, h("div", { class: "frames-row" }, h("code", { title: frame }, shortName(frame, parent)), age), place, below.length > 0 && h("ul", {}, ...below));
    });
  }

  #draw(): void {
    const { transforms, connection } = this.context;
    for (const [frame, { age, place }] of this.#rows) {
      const link = transforms.links.get(frame);
      setText(age, link ? ageOf(link, connection.nowNs) : "root");
      const text = link ? placeText(link) : "";
      setText(place, text);
      place.title = text; // deep in the tree of a narrow panel it is cut
      age.classList.toggle("bad", link !== undefined && link.source === "tf" && link.stampNs > 0n && secondsOf(link, connection.nowNs) > 2);
    }
  }
}

/** A frame that is named after its parent: "…/camera". */
function shortName(frame: string, parent: string): string {
  return parent !== "" && frame.startsWith(`${parent}/`) ? `…${frame.slice(parent.length)}` : frame;
}

function secondsOf({ stampNs }: Link, nowNs: bigint): number {
  return Math.max(0, Number(nowNs - stampNs) / 1e9);
}

function ageOf(link: Link, nowNs: bigint): string {
  if (link.source !== "tf") return link.source === "static" ? "static" : "from odometry";
  return `${secondsOf(link, nowNs).toFixed(1)} s`;
}

function placeText({ parent_T_child: { translation: [x, y, z], rotation } }: Link): string {
  return `${fixed(x, 2)}, ${fixed(y, 2)}, ${fixed(z, 2)} m  ${fixed((yawOf(rotation) * 180) / Math.PI, 0)}°`;
}

registerPanel({
  id: "frames",
  title: "Frames",
  icon: "frames",
  place: "left",
  hint: "The tree of transforms, with their age.",
  create: (container, context) => new FramesPanel(container, context),
});
