/** All nodes and whether they respond: the live view probes those of other programs twice a second. */

import type { NodeReport } from "../connection/connection";
import { ageText } from "../robot/text";
import { h, setText } from "../ui/dom";
import { emptyState } from "./empty";
import { registerPanel, type PanelContext, type PanelInstance } from "./panel";
import "./nodes.css";

const RANK: Partial<Record<NodeReport["state"], number>> = { silent: 0, gone: 1 };
const MEANING = {
  alive: "responds",
  silent: "stopped, blocked or disconnected",
  gone: "ended or disconnected",
  unknown: "has no parameter services, so its state is unknown",
};

class NodesPanel implements PanelInstance {
  readonly #count = h("span", { class: "quiet" });
  readonly #list = h("ul", { id: "nodes" });
  readonly #empty = emptyState("nodes", "No nodes yet", "The program has not reported its nodes.");
  readonly #end: () => void;
  #isVisible = false;

  constructor(
    container: HTMLElement,
    private readonly context: PanelContext,
  ) {
    container.append(h("div", { class: "panel nodes" }, h("div", { class: "bar" }, this.#count), h("div", { class: "body", tabindex: "0", role: "region", "aria-label": "Nodes" }, this.#list, this.#empty.element)));
    this.#end = context.connection.on("nodes", () => this.#draw());
  }

  setVisible(isVisible: boolean): void {
    this.#isVisible = isVisible;
    this.#draw();
  }

  dispose(): void {
    this.#end();
  }

  #draw(): void {
    if (!this.#isVisible) return;
    const { nodes } = this.context.connection;
    const sorted = [...nodes].sort((a, b) => (RANK[a.state] ?? 2) - (RANK[b.state] ?? 2) || (a.name < b.name ? -1 : 1));
    const bad = sorted.filter(({ state }) => state in RANK).length;
    setText(this.#count, `${sorted.length} nodes${bad > 0 ? `, ${bad} missing` : ""}`);
    this.#empty.element.hidden = sorted.length > 0;
    while (this.#list.children.length > sorted.length) this.#list.lastElementChild?.remove();
    sorted.forEach((report, index) => {
      const item = this.#list.children[index] ?? this.#list.appendChild(h("li", {}, h("i"), h("code"), h("small")));
      drawNode(item as HTMLElement, report);
    });
  }
}

function drawNode(item: HTMLElement, { name, state, since }: NodeReport): void {
  if (item.className !== state) item.className = state;
  const code = item.children[1]!;
  // Long names break at their words.
  if (code.textContent !== name) code.replaceChildren(...name.split(/(?<=[_/])/).flatMap((word) => [word, h("wbr")]));
  const notes = { silent: `no response for ${ageText(since)}`, gone: `gone for ${ageText(since)}`, unknown: "state unknown", alive: "" };
  setText(item.children[2]!, notes[state]);
  item.title = MEANING[state];
}

registerPanel({
  id: "nodes",
  title: "Nodes",
  icon: "nodes",
  place: "left",
  hint: "All nodes, and which of them do not respond.",
  create: (container, context) => new NodesPanel(container, context),
});
