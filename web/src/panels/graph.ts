/** Nodes and the topics between them. */

import "./graph.css";
import type { Dispose } from "../connection/connection";
import { h, setText, svg } from "../ui/dom";
import { nextFrame } from "../ui/frames";
import { emptyState } from "./empty";
import { type GraphEdge, type GraphLayout, edgesOf, layOut } from "./graph_layout";
import { type PanelContext, type PanelInstance, registerPanel } from "./panel";

const WIDTH = 132;
const HEIGHT = 30;
const COLUMN = 176;
const ROW = 50;
const MARGIN = 12;
/** Text of 12 px remains readable. */
const LEAST_SCALE = 0.9;

class GraphPanel implements PanelInstance {
  readonly #drawing = h("div", { class: "graph-drawing" });
  readonly #detail = h("div", { class: "graph-detail hint", role: "status" });
  readonly #empty = emptyState("graph", "No nodes", "Nodes appear as soon as they publish or subscribe.");
  readonly #common: HTMLInputElement;
  readonly #ends: Dispose[] = [];
  #drawn = "";
  #chosen = "";
  #edges: readonly GraphEdge[] = [];

  constructor(
    container: HTMLElement,
    private readonly context: PanelContext,
  ) {
    this.#common = h("input", { type: "checkbox", checked: context.settings.get<boolean>("common", false), onchange: () => {
      context.settings.set("common", this.#common.checked);
      this.#draw();
    } });
    container.append(h("div", { class: "panel" }, h("div", { class: "bar" }, h("label", { class: "hint" }, this.#common, "Log, clock, transforms")),
      h("div", { class: "body graph-body", tabindex: "0", role: "region", "aria-label": "Node graph" }, this.#drawing, this.#empty.element), this.#detail));
    this.#detail.hidden = true;
  }

  setVisible(isVisible: boolean): void {
    for (const end of this.#ends.splice(0)) end();
    if (!isVisible) return;
    const { connection } = this.context;
    const again = (): void => nextFrame(this.#draw);
    this.#ends.push(connection.on("topics", again), connection.on("nodes", again));
    this.#draw();
  }

  dispose = (): void => {
    this.setVisible(false);
  };

  readonly #draw = (): void => {
    const { connection } = this.context;
    const topics = [...connection.topics.values()];
    const edges = edgesOf(topics, this.#common.checked);
    const names = [...new Set(topics.flatMap(({ publishers, subscribers }) => [...publishers, ...subscribers]))].filter((name) => !name.split("/").some((part) => part.startsWith("_"))).sort();
    const states = new Map(connection.nodes.map(({ name, state }) => [name, state]));
    const key = JSON.stringify([names, edges, [...states]]);
    this.#empty.element.hidden = names.length > 0;
    this.#drawing.hidden = names.length === 0;
    if (key === this.#drawn) return;
    this.#drawn = key;
    this.#edges = edges;
    const connected = names.filter((name) => edges.some(({ from, to }) => from === name || to === name));
    const loose = names.filter((name) => !connected.includes(name));
    const layout = layOut(connected, edges);
    const picture = this.#picture(layout, edges, loose, states);
    // Fitted to the panel, but not below a size at which names are readable.
    const width = Number(picture.getAttribute("width"));
    picture.style.width = `clamp(${Math.round(LEAST_SCALE * width)}px, 100%, ${width}px)`;
    this.#drawing.replaceChildren(picture);
    this.#mark();
  };

  #picture(layout: GraphLayout, edges: readonly GraphEdge[], loose: readonly string[], states: ReadonlyMap<string, string>): SVGElement {
    const at = (name: string): [number, number] => {
      const place = layout.places.get(name);
      if (place) return [MARGIN + place.column * COLUMN, MARGIN + place.row * ROW];
      const index = loose.indexOf(name);
      const perRow = Math.max(1, layout.columns);
      return [MARGIN + (index % perRow) * COLUMN, MARGIN + (layout.rows + 0.4 + Math.floor(index / perRow)) * ROW];
    };
    const width = 2 * MARGIN + (Math.max(1, layout.columns) - 1) * COLUMN + WIDTH;
    const looseRows = loose.length > 0 ? 0.4 + Math.ceil(loose.length / Math.max(1, layout.columns)) : 0;
    const height = 2 * MARGIN + (layout.rows + looseRows - 1) * ROW + HEIGHT;
    const marker = svg("marker", { id: "graph-arrow", viewBox: "0 0 8 8", refX: 7, refY: 4, markerWidth: 7, markerHeight: 7, orient: "auto" }, svg("path", { d: "M0 0 8 4 0 8z" }));
    const lines = edges.map((edge) => this.#line(edge, at(edge.from), at(edge.to)));
    const boxes = [...layout.places.keys(), ...loose].map((name) => this.#box(name, at(name), states.get(name) ?? "alive"));
    return svg("svg", { viewBox: `0 0 ${width} ${height}`, width, height, role: "group", "aria-label": `${boxes.length} nodes` }, svg("defs", {}, marker), ...lines, ...boxes);
  }

  #line(edge: GraphEdge, [x1, y1]: [number, number], [x2, y2]: [number, number]): SVGElement {
    const isBack = x2 <= x1;
    const [sx, sy] = isBack ? [x1 + WIDTH / 2, y1 + HEIGHT] : [x1 + WIDTH, y1 + HEIGHT / 2];
    const [ex, ey] = isBack ? [x2 + WIDTH / 2, y2 + HEIGHT] : [x2 - 2, y2 + HEIGHT / 2];
    const bend = isBack ? 26 : Math.max(30, (ex - sx) / 2);
    const d = isBack ? `M${sx} ${sy} C${sx} ${sy + bend} ${ex} ${ey + bend} ${ex} ${ey + 2}` : `M${sx} ${sy} C${sx + bend} ${sy} ${ex - bend} ${ey} ${ex} ${ey}`;
    return svg("g", { class: `graph-edge${isBack ? " graph-back" : ""}`, "data-from": edge.from, "data-to": edge.to },
      svg("title", {}, `${edge.from} → ${edge.to}: ${edge.topics.join(", ")}`), svg("path", { class: "graph-target", d }), svg("path", { d, "marker-end": "url(#graph-arrow)" }));
  }

  #box(name: string, [x, y]: [number, number], state: string): SVGElement {
    const text = name.replace(/^\//, "");
    const shown = text.length > 19 ? `${text.slice(0, 18)}…` : text;
    const choose = (): void => {
      this.#chosen = this.#chosen === name ? "" : name;
      this.#mark();
    };
    return svg("g", { class: `graph-node graph-${state}`, "data-name": name, tabindex: "0", role: "button", "aria-label": `Node ${name}`, "aria-pressed": "false", transform: `translate(${x} ${y})`,
      onclick: choose,
      onkeydown: (event: KeyboardEvent) => {
        if (event.key !== "Enter" && event.key !== " ") return;
        event.preventDefault();
        event.stopPropagation();
        choose();
      } }, svg("title", {}, name), svg("rect", { width: WIDTH, height: HEIGHT, rx: 7 }), svg("text", { x: WIDTH / 2, y: HEIGHT / 2 + 4 }, shown));
  }

  /** Show the topics of the chosen node, and dim what is not connected to it. */
  #mark(): void {
    const picture = this.#drawing.firstElementChild;
    const near = new Set([this.#chosen]);
    for (const edge of picture?.querySelectorAll<SVGElement>(".graph-edge") ?? []) {
      const [from, to] = [edge.dataset["from"]!, edge.dataset["to"]!];
      const isNear = from === this.#chosen || to === this.#chosen;
      if (isNear) near.add(from).add(to);
      edge.classList.toggle("graph-near", isNear);
    }
    for (const node of picture?.querySelectorAll<SVGElement>(".graph-node") ?? []) {
      const name = node.dataset["name"]!;
      node.classList.toggle("graph-near", near.has(name));
      node.setAttribute("aria-pressed", String(name === this.#chosen));
    }
    picture?.classList.toggle("graph-chosen", this.#chosen !== "");
    this.#detail.hidden = this.#chosen === "";
    const list = (edges: readonly GraphEdge[]): string => [...new Set(edges.flatMap(({ topics }) => topics))].sort().join(", ") || "none";
    const inputs = list(this.#edges.filter(({ to }) => to === this.#chosen));
    const outputs = list(this.#edges.filter(({ from }) => from === this.#chosen));
    setText(this.#detail, this.#chosen ? `${this.#chosen} · receives ${inputs} · publishes ${outputs}` : "");
  }
}

registerPanel({
  id: "graph",
  title: "Node graph",
  icon: "graph",
  place: "below",
  hint: "Nodes and the topics between them.",
  create: (container, context) => new GraphPanel(container, context),
});
