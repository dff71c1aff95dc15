/** The behaviour tree that runs, and its last transitions. */

import "./behavior_tree.css";
import type { Dispose } from "../connection/connection";
import { nanosecondsOf, type Stamp } from "../transforms/stamp";
import { h } from "../ui/dom";
import { nextFrame } from "../ui/frames";
import { treeLine, type TreeStatus } from "./behavior_tree_text";
import { emptyState } from "./empty";
import { stampText } from "./format";
import { type PanelContext, type PanelInstance, registerPanel } from "./panel";

const SIGNS: Readonly<Record<TreeStatus, string>> = { running: "●", succeeded: "✓", failed: "✕", idle: "○" };
const NAV2: Readonly<Record<string, TreeStatus>> = { RUNNING: "running", SUCCESS: "succeeded", FAILURE: "failed", IDLE: "idle" };
const MOST_CHANGES = 100;

interface TreeLog {
  timestamp: Stamp;
  event_log: { node_name: string; previous_status: string; current_status: string }[];
}

class BehaviorTreePanel implements PanelInstance {
  readonly #tree = h("ul", { class: "tree-lines" });
  readonly #changes = h("ol", { class: "tree-changes" });
  readonly #history: HTMLElement;
  readonly #empty = emptyState("tree", "No behaviour tree", "A node that publishes /behavior_tree or /behavior_tree_log appears here.");
  readonly #subscriptions: Dispose[] = [];
  readonly #last = new Map<string, TreeStatus>();
  #text = "";

  constructor(
    container: HTMLElement,
    private readonly context: PanelContext,
  ) {
    this.#history = h("details", { class: "tree-history" }, h("summary", {}, "Last changes"), this.#changes);
    container.append(h("div", { class: "panel" }, h("div", { class: "body", tabindex: "0", role: "region", "aria-label": "Behaviour tree" }, this.#tree, this.#history, this.#empty.element)));
    this.#show();
  }

  setVisible(isVisible: boolean): void {
    for (const end of this.#subscriptions.splice(0)) end();
    if (!isVisible) return;
    const { connection } = this.context;
    this.#subscriptions.push(
      connection.subscribe<{ data: string }>("/behavior_tree", { rateHz: 10 }, ({ value }) => {
        this.#text = value.data;
        nextFrame(this.#draw);
      }),
      connection.subscribe<TreeLog>("/behavior_tree_log", { every: true }, ({ value }) => this.#note(value)),
      connection.on("status", ({ state }) => {
        if (state === "lost") this.#clear();
      }),
    );
  }

  dispose = (): void => {
    this.setVisible(false);
  };

  #clear(): void {
    this.#text = "";
    this.#last.clear();
    this.#changes.replaceChildren();
    this.#draw();
  }

  #note({ timestamp, event_log: events }: TreeLog): void {
    const stamp = stampText(nanosecondsOf(timestamp));
    for (const { node_name: name, current_status: current } of events) {
      const status = NAV2[current] ?? "idle";
      this.#last.set(name, status);
      this.#changes.prepend(h("li", { class: `tree-${status}` }, h("time", { class: "quiet" }, stamp), sign(status), h("span", {}, name)));
    }
    while (this.#changes.children.length > MOST_CHANGES) this.#changes.lastChild!.remove();
    nextFrame(this.#draw);
  }

  readonly #draw = (): void => {
    if (this.#text) this.#tree.replaceChildren(...this.#text.split("\n").filter(Boolean).map((line) => this.#line(line)));
    // Nav2 publishes the changes of its leaves only: list what is known of each.
    else this.#tree.replaceChildren(...[...this.#last].map(([name, status]) => h("li", { class: `tree-${status}` }, sign(status), h("span", {}, name))));
    this.#show();
  };

  #line(text: string): HTMLElement {
    const node = treeLine(text);
    if (!node) return h("li", { class: "quiet" }, text);
    const line = h("li", { class: `tree-${node.status}` }, sign(node.status), h("span", {}, node.name), node.note ? h("small", { class: "quiet" }, node.note) : null);
    line.style.paddingLeft = `${1.2 * node.depth}rem`;
    return line;
  }

  #show(): void {
    const isEmpty = this.#tree.children.length === 0;
    this.#empty.element.hidden = !isEmpty;
    this.#tree.hidden = isEmpty;
    this.#history.hidden = this.#changes.children.length === 0;
  }
}

function sign(status: TreeStatus): HTMLElement {
  return h("span", { class: "tree-sign", role: "img", "aria-label": status, title: status }, SIGNS[status]);
}

registerPanel({
  id: "tree",
  title: "Behaviour tree",
  icon: "tree",
  place: "right",
  hint: "What the robot does now, and what it does next.",
  create: (container, context) => new BehaviorTreePanel(container, context),
});
