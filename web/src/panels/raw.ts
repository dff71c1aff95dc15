/** The messages of a topic as a tree: pausable, compared, copied. */

import "./raw.css";
import type { Dispose, Message } from "../connection/connection";
import { h, setText } from "../ui/dom";
import { nextFrame } from "../ui/frames";
import { icon } from "../ui/icons";
import { emptyState } from "./empty";
import { bytesText, shortType, stampText } from "./format";
import { type PanelContext, type PanelInstance, registerPanel } from "./panel";
import { RawTree } from "./raw_tree";
import { topicSelect, type TopicSelect } from "./topic_select";

const RATE_HZ = 5;

class RawPanel implements PanelInstance {
  readonly #select: TopicSelect;
  readonly #tree: RawTree;
  readonly #empty = emptyState("raw", "No topic chosen", "Choose a topic to see its messages.");
  readonly #pause = h("button", { class: "bare", "aria-pressed": "false", title: "Pause", "aria-label": "Pause", onclick: () => this.#setPaused(!this.#isPaused) }, icon("pause"));
  readonly #compare = h("button", { "aria-pressed": "false", title: "Compare further messages with this one", onclick: () => this.#switchCompare() }, "Compare");
  readonly #facts = h("p", { class: "hint number raw-facts" });
  #subscription: Dispose | null = null;
  #isPaused = false;
  #isComparing = false;
  #isVisible = false;
  #message: Message | null = null;

  constructor(
    container: HTMLElement,
    private readonly context: PanelContext,
  ) {
    const { settings, connection } = context;
    this.#tree = new RawTree({ onPlot: (path) => context.open("plot", { paths: [this.#select.value + path] }) });
    this.#select = topicSelect(connection, {
      label: "Topic",
      value: settings.get<string>("topic", ""),
      accepts: ({ name }) => !name.split("/").some((part) => part.startsWith("_")),
      onChange: (topic) => {
        settings.set("topic", topic);
        this.#begin();
      },
    });
    const copy = h("button", { class: "bare", title: "Copy as JSON", "aria-label": "Copy as JSON", onclick: () => void this.#copy() }, icon("copy"));
    const expand = h("button", { class: "bare", title: "Expand", "aria-label": "Expand all", onclick: () => this.#tree.expandAll(4) }, icon("plus"));
    container.append(h("div", { class: "panel" }, h("div", { class: "bar raw-bar" }, this.#select.element, h("div", { class: "row" }, this.#pause, this.#compare, expand, copy)),
      h("div", { class: "body", tabindex: "0", role: "region", "aria-label": "Message" }, this.#facts, this.#tree.element, this.#empty.element)));
    this.#begin();
  }

  setVisible(isVisible: boolean): void {
    this.#isVisible = isVisible;
    this.#subscribe();
  }

  dispose = (): void => {
    this.#subscription?.();
    this.#select.dispose();
  };

  #begin(): void {
    this.#message = null;
    const topic = this.#select.value;
    this.context.setTitle(topic || "Raw message");
    this.#setPaused(false);
    if (this.#isComparing) this.#switchCompare();
    this.#subscribe();
    this.#show();
  }

  #subscribe(): void {
    this.#subscription?.();
    this.#subscription = null;
    const topic = this.#select.value;
    if (!this.#isVisible || !topic || this.#isPaused) return;
    this.#subscription = this.context.connection.subscribe(topic, { rateHz: RATE_HZ }, (message) => {
      const isFirst = this.#message === null;
      this.#message = message;
      nextFrame(this.#draw);
      if (isFirst) nextFrame(() => this.#tree.expandAll(2));
    });
  }

  #setPaused(isPaused: boolean): void {
    this.#isPaused = isPaused;
    this.#pause.setAttribute("aria-pressed", String(isPaused));
    this.#pause.replaceChildren(icon(isPaused ? "play" : "pause"));
    this.#pause.title = isPaused ? "Continue" : "Pause";
    this.#pause.setAttribute("aria-label", this.#pause.title);
    this.#subscribe();
  }

  #switchCompare(): void {
    this.#isComparing = !this.#isComparing && this.#message !== null;
    this.#compare.setAttribute("aria-pressed", String(this.#isComparing));
    this.#tree.compare(this.#isComparing && this.#message ? { message: this.#message.value } : null);
    this.#show();
  }

  readonly #draw = (): void => {
    if (!this.#message) return;
    this.#tree.update(this.#message.value);
    this.#show();
  };

  #show(): void {
    const message = this.#message;
    this.#empty.element.hidden = message !== null;
    this.#tree.element.hidden = message === null;
    this.#facts.hidden = message === null;
    if (message) {
      const differing = this.#isComparing ? ` · ${this.#tree.differences || "no"} ${this.#tree.differences === 1 ? "value differs" : "values differ"}` : "";
      setText(this.#facts, `${shortType(message.type)} · ${stampText(message.stampNs)} · ${bytesText(message.bytes)}${differing}`);
      return;
    }
    const topic = this.#select.value;
    if (!topic) this.#empty.set("No topic chosen", "Choose a topic to see its messages.");
    else if (!this.context.connection.topics.get(topic)?.isPublished) this.#empty.set("Not published", `No node publishes ${topic} now. Its messages appear here as soon as one does.`);
    else this.#empty.set("No message yet", `${topic} has a publisher, but it has not published since.`);
  }

  async #copy(): Promise<void> {
    if (!this.#message) return;
    const text = JSON.stringify(this.#message.value, (_key, value: unknown) => (typeof value === "bigint" ? Number(value) : ArrayBuffer.isView(value) ? Array.from(value as unknown as ArrayLike<unknown>) : value), 2);
    try {
      await navigator.clipboard.writeText(text);
      this.context.announce("Message copied");
    } catch {
      this.context.announce("The browser does not permit copying", "error");
    }
  }
}

registerPanel({
  id: "raw",
  title: "Raw message",
  icon: "raw",
  place: "right",
  isMultiple: true,
  hint: "The messages of a topic, field by field.",
  create: (container, context) => new RawPanel(container, context),
});
