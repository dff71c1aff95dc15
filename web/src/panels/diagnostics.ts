/** Health: the state of every node, and what nodes report about themselves. */

import "./diagnostics.css";
import type { Dispose, NodeReport } from "../connection/connection";
import { h, setText } from "../ui/dom";
import { nextFrame } from "../ui/frames";
import { emptyState } from "./empty";
import { clockText, numberText } from "./format";
import { type PanelContext, type PanelInstance, registerPanel } from "./panel";

interface Status {
  level: number;
  name: string;
  message: string;
  hardware_id: string;
  values: { key: string; value: string }[];
}

const LEVELS = ["ok", "warning", "error", "stale"] as const;
const STATE_TEXTS: Readonly<Record<NodeReport["state"], string>> = { alive: "alive", silent: "not responding", gone: "gone", unknown: "cannot be checked" };
const STATUS_TYPE = /\/DiagnosticStatus$/;

class DiagnosticsPanel implements PanelInstance {
  readonly #statuses = new Map<string, Status>();
  readonly #open = new Set<string>();
  readonly #nodes = h("ul", { class: "diagnostics-nodes" });
  readonly #nodesTitle = h("h2", {}, "Nodes");
  readonly #list = h("div", { class: "diagnostics-list" });
  readonly #listTitle = h("h2", {}, "Reports");
  readonly #empty = emptyState("diagnostics", "Nothing to report", "States of nodes and /diagnostics appear here.");
  readonly #ends: Dispose[] = [];
  readonly #topics = new Map<string, Dispose>();

  constructor(
    container: HTMLElement,
    private readonly context: PanelContext,
  ) {
    container.append(h("div", { class: "panel diagnostics" }, h("div", { class: "body", tabindex: "0", role: "region", "aria-label": "Diagnostics" },
      this.#nodesTitle, this.#nodes, this.#listTitle, this.#list, this.#empty.element)));
    this.#draw();
  }

  setVisible(isVisible: boolean): void {
    for (const end of this.#ends.splice(0)) end();
    for (const end of this.#topics.values()) end();
    this.#topics.clear();
    if (!isVisible) return;
    const { connection } = this.context;
    this.#ends.push(
      connection.subscribe<{ status: Status[] }>("/diagnostics", { every: true }, ({ value }) => value.status.forEach((status) => this.#take(status))),
      connection.on("nodes", () => nextFrame(this.#draw)),
      connection.on("topics", () => this.#subscribe()),
      connection.on("status", ({ state }) => {
        if (state !== "lost") return;
        this.#statuses.clear();
        nextFrame(this.#draw);
      }),
    );
    this.#subscribe();
    this.#draw();
  }

  dispose = (): void => {
    this.setVisible(false);
  };

  /** Single reports have topics of their own, such as /planner/status. */
  #subscribe(): void {
    const { connection } = this.context;
    for (const { name, type, isPublished } of connection.topics.values()) {
      if (!isPublished || !STATUS_TYPE.test(type) || this.#topics.has(name)) continue;
      this.#topics.set(name, connection.subscribe<Status>(name, { rateHz: 5 }, ({ value }) => this.#take({ ...value, name: value.name || name })));
    }
  }

  #take(status: Status): void {
    this.#statuses.set(status.name, status);
    nextFrame(this.#draw);
  }

  readonly #draw = (): void => {
    const { nodes } = this.context.connection;
    const order = { silent: 0, gone: 1, alive: 2, unknown: 3 } as const;
    const sorted = [...nodes].sort((a, b) => order[a.state] - order[b.state] || a.name.localeCompare(b.name));
    this.#nodes.replaceChildren(...sorted.map((report) => h("li", { class: `diagnostics-${report.state}` }, h("span", { class: "diagnostics-dot", "aria-hidden": "true" }), h("span", { class: "mono" }, report.name),
      h("span", { class: "quiet" }, report.state === "alive" ? "" : `${STATE_TEXTS[report.state]}${report.since > 0 ? ` for ${clockText(report.since)}` : ""}`))));
    this.#nodesTitle.hidden = sorted.length === 0;
    const isAlive = sorted.filter(({ state }) => state === "alive").length;
    setText(this.#nodesTitle, `Nodes · ${isAlive} of ${sorted.length} alive`);
    const statuses = [...this.#statuses.values()].sort((a, b) => b.level - a.level || a.name.localeCompare(b.name));
    // The one that is open keeps the focus: elements are kept by name.
    const known = new Map([...this.#list.children].map((each) => [(each as HTMLElement).dataset["name"], each as HTMLDetailsElement]));
    this.#list.replaceChildren(...statuses.map((status) => this.#row(status, known.get(status.name))));
    this.#listTitle.hidden = statuses.length === 0;
    this.#empty.element.hidden = sorted.length + statuses.length > 0;
  };

  #row(status: Status, known: HTMLDetailsElement | undefined): HTMLElement {
    const level = LEVELS[status.level] ?? "stale";
    const row = known ?? h("details", { "data-name": status.name, ontoggle: () => {
      if (row.open) this.#open.add(status.name);
      else this.#open.delete(status.name);
    } }, h("summary"), h("dl"));
    row.className = `diagnostics-${level}`;
    row.open = this.#open.has(status.name);
    row.querySelector("summary")!.replaceChildren(h("span", { class: "diagnostics-dot", role: "img", "aria-label": level }), h("strong", {}, status.name), h("span", {}, status.message));
    row.querySelector("dl")!.replaceChildren(...status.values.flatMap(({ key, value }) => [h("dt", {}, key), h("dd", { class: "number" }, valueText(value))]));
    return row;
  }
}

/** Numbers of computations come with all their digits. */
function valueText(value: string): string {
  return /^-?\d+\.\d{5,}$/.test(value) ? numberText(Number(value), 5) : value;
}

registerPanel({
  id: "diagnostics",
  title: "Diagnostics",
  icon: "diagnostics",
  place: "right",
  hint: "The state of every node and what nodes report.",
  create: (container, context) => new DiagnosticsPanel(container, context),
});
