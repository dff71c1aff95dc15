/** Topics with type, rate and bandwidth; a row opens the message. */

import "./topics.css";
import type { Connection, Dispose, Topic } from "../connection/connection";
import { h, setText } from "../ui/dom";
import { every } from "../ui/frames";
import { icon } from "../ui/icons";
import { emptyState } from "./empty";
import { bytesText, rateText, shortType } from "./format";
import { type PanelContext, type PanelInstance, registerPanel } from "./panel";

/** Measured on request only: an unwatched camera is not rendered. */
const HEAVY = /\/(Image|CompressedImage|PointCloud2)$/;
/** Parts of actions and of the graph itself. */
const isHidden = (name: string): boolean => name.split("/").some((part) => part.startsWith("_"));

interface Row {
  readonly element: HTMLTableRowElement;
  readonly type: HTMLElement;
  readonly rate: HTMLElement;
  readonly hz: HTMLElement;
  /** The bandwidth once more, where the panel is too narrow for its column. */
  readonly below: HTMLElement;
  readonly bandwidth: HTMLElement;
  readonly ends: HTMLElement;
  topic: Topic;
}

class TopicsPanel implements PanelInstance {
  readonly #rows = new Map<string, Row>();
  readonly #measured = new Map<string, Dispose>();
  readonly #asked = new Set<string>();
  readonly #body = h("tbody");
  readonly #table: HTMLElement;
  readonly #empty = emptyState("topics", "No topics", "Topics appear as soon as a node publishes or subscribes.");
  readonly #filter: HTMLInputElement;
  readonly #count = h("span", { class: "hint number" });
  readonly #ends: Dispose[] = [];
  #draw: Dispose | null = null;

  constructor(
    container: HTMLElement,
    private readonly context: PanelContext,
    private readonly connection: Connection = context.connection,
  ) {
    this.#filter = h("input", { type: "search", placeholder: "Filter", "aria-label": "Filter topics", class: "grow", oninput: () => this.#list() });
    const head = h("tr", {}, h("th", { scope: "col" }, "Topic"), h("th", { scope: "col", class: "topics-number" }, "Hz", h("span", { class: "topics-below" }, "Bandwidth")),
      h("th", { scope: "col", class: "topics-number" }, "Bandwidth"), h("th", { scope: "col", class: "topics-ends" }, "Ends"));
    this.#table = h("table", { class: "topics-table" }, h("thead", {}, head), this.#body);
    container.append(h("div", { class: "panel" }, h("div", { class: "bar" }, this.#filter, this.#count),
      h("div", { class: "body topics-body", tabindex: "0", role: "region", "aria-label": "Topics" }, this.#table, this.#empty.element)));
    this.#ends.push(this.connection.on("topics", () => this.#list()), this.connection.on("status", () => this.#list()));
    this.#list();
  }

  setVisible(isVisible: boolean): void {
    if (isVisible && !this.#draw) {
      this.#draw = every(2, () => this.#show());
      this.#list();
    } else if (!isVisible) {
      this.#draw?.();
      this.#draw = null;
      this.#measure([]);
    }
  }

  dispose = (): void => {
    this.setVisible(false);
    for (const end of this.#ends) end();
  };

  #list(): void {
    const words = this.#filter.value.toLowerCase().split(/\s+/).filter(Boolean);
    const all = [...this.connection.topics.values()].filter(({ name }) => !isHidden(name));
    const shown = all.filter(({ name, type }) => words.every((word) => `${name} ${type}`.toLowerCase().includes(word)));
    for (const [name, row] of this.#rows) {
      if (shown.some((topic) => topic.name === name)) continue;
      row.element.remove();
      this.#rows.delete(name);
    }
    shown.forEach((topic, index) => {
      let row = this.#rows.get(topic.name);
      if (!row) this.#rows.set(topic.name, (row = this.#row(topic)));
      row.topic = topic;
      setText(row.type, shortType(topic.type) || "not published");
      row.type.title = topic.type;
      setText(row.ends, `${topic.publishers.length} → ${topic.subscribers.length}`);
      row.ends.title = `Publishers: ${topic.publishers.join(", ") || "none"}\nSubscribers: ${topic.subscribers.join(", ") || "none"}`;
      if (this.#body.children[index] !== row.element) this.#body.insertBefore(row.element, this.#body.children[index] ?? null);
    });
    this.#table.hidden = shown.length === 0;
    this.#empty.element.hidden = shown.length > 0;
    if (all.length > 0) this.#empty.set("Nothing matches", "No topic name or type contains the filter.");
    else if (this.connection.status.state === "live") this.#empty.set("No topics", "Topics appear as soon as a node publishes or subscribes.");
    else this.#empty.set("Not connected", this.connection.status.reason || "Connecting…");
    setText(this.#count, shown.length < all.length ? `${shown.length} of ${all.length}` : String(all.length));
    if (this.#draw) this.#measure(shown.filter((topic) => topic.isPublished && (!HEAVY.test(topic.type) || this.#asked.has(topic.name))).map(({ name }) => name));
    this.#show();
  }

  #row(topic: Topic): Row {
    const { name } = topic;
    const type = h("small", { class: "quiet" });
    const rate = h("td", { class: "topics-number number" });
    const bandwidth = h("td", { class: "topics-number number" });
    const ends = h("td", { class: "topics-ends number quiet" });
    const open = h("button", { class: "bare topics-name", title: `Show the messages of ${name}`, onclick: () => this.context.open("raw", { topic: name }) }, name);
    const element = h("tr", {}, h("td", {}, open, type), rate, bandwidth, ends);
    return { element, type, rate, hz: h("span"), below: h("span", { class: "topics-below" }), bandwidth, ends, topic };
  }

  #measure(names: readonly string[]): void {
    for (const [name, end] of this.#measured) {
      if (names.includes(name)) continue;
      end();
      this.#measured.delete(name);
    }
    for (const name of names) {
      if (!this.#measured.has(name)) this.#measured.set(name, this.connection.subscribe(name, { rateHz: 1 }, () => undefined));
    }
  }

  #show(): void {
    for (const [name, row] of this.#rows) {
      const isOnRequest = row.topic.isPublished && HEAVY.test(row.topic.type) && !this.#asked.has(name);
      if (isOnRequest) {
        if (!row.rate.querySelector("button")) {
          const ask = (): void => {
            this.#asked.add(name);
            this.#list();
          };
          row.rate.replaceChildren(h("button", { class: "bare", title: "Subscribe to measure it", "aria-label": `Measure ${name}`, onclick: ask }, icon("eye")));
          setText(row.bandwidth, "");
        }
        continue;
      }
      const statistics = row.topic.isPublished ? this.connection.statistics(name) : null;
      const bandwidth = statistics && statistics.bytesPerS > 0 ? `${bytesText(statistics.bytesPerS)}/s` : "";
      setText(row.hz, statistics && statistics.count > 0 ? rateText(statistics.rateHz) : "–");
      if (!row.hz.isConnected) row.rate.replaceChildren(row.hz, row.below);
      setText(row.below, bandwidth);
      setText(row.bandwidth, bandwidth || "–");
    }
  }
}

registerPanel({
  id: "topics",
  title: "Topics",
  icon: "topics",
  place: "right",
  hint: "All topics with type, rate and bandwidth.",
  create: (container, context) => new TopicsPanel(container, context),
});
