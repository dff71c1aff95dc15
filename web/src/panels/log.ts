/** Log lines of all nodes, by level, node and text. */

import "./log.css";
import type { Dispose } from "../connection/connection";
import type { LogEntry } from "../robot/log_history";
import { h, setText } from "../ui/dom";
import { nextFrame } from "../ui/frames";
import { icon } from "../ui/icons";
import { emptyState } from "./empty";
import { download, stampText } from "./format";
import { type PanelContext, type PanelInstance, registerPanel } from "./panel";

const MOST_SHOWN = 500;
const LEVELS = [
  { least: 10, name: "Debug", short: "D" },
  { least: 20, name: "Info", short: "I" },
  { least: 30, name: "Warning", short: "W" },
  { least: 40, name: "Error", short: "E" },
  { least: 50, name: "Fatal", short: "F" },
] as const;

class LogPanel implements PanelInstance {
  readonly #list = h("ol", { class: "log-list" });
  readonly #body: HTMLElement;
  readonly #empty = emptyState("log", "No log lines", "Nodes write here with their logger.");
  readonly #level: HTMLSelectElement;
  readonly #node: HTMLSelectElement;
  readonly #text: HTMLInputElement;
  readonly #count = h("span", { class: "hint number" });
  readonly #latest: HTMLButtonElement;
  readonly #nodes = new Set<string>();
  #follows = true;
  #isVisible = false;
  readonly #ends: Dispose[] = [];
  #shownUpTo = 0;

  constructor(
    container: HTMLElement,
    private readonly context: PanelContext,
  ) {
    const { settings, log } = context;
    const again = (): void => {
      settings.set("level", Number(this.#level.value));
      settings.set("node", this.#node.value);
      this.#redraw();
    };
    this.#level = h("select", { "aria-label": "Least level", onchange: again });
    this.#level.append(...LEVELS.map(({ least, name }) => new Option(name, String(least))));
    this.#level.value = String(settings.get("level", 20));
    this.#node = h("select", { "aria-label": "Node", onchange: again });
    this.#node.append(new Option("All nodes", ""));
    const chosen = settings.get<string>("node", "");
    if (chosen) this.#addNode(chosen);
    this.#node.value = chosen;
    this.#text = h("input", { type: "search", placeholder: "Filter", "aria-label": "Filter by text", class: "grow", oninput: () => this.#redraw() });
    this.#latest = h("button", { class: "log-latest", hidden: true, onclick: () => this.#follow() }, icon("down"), "Newest");
    this.#body = h("div", { class: "body log-body", tabindex: "0", role: "region", "aria-label": "Log" }, this.#list, this.#empty.element);
    this.#body.addEventListener("scroll", () => this.#onScroll());
    const clear = h("button", { class: "bare", title: "Clear", "aria-label": "Clear", onclick: () => log.clear() }, icon("close"));
    const save = h("button", { class: "bare", title: "Save as text", "aria-label": "Save as text", onclick: () => this.#save() }, icon("download"));
    container.append(h("div", { class: "panel log" }, h("div", { class: "bar one-row" }, this.#level, this.#node, this.#text, this.#count, save, clear), this.#body, this.#latest));
    this.#ends.push(log.onChange(() => this.#onChange()));
    this.#redraw();
  }

  setVisible(isVisible: boolean): void {
    this.#isVisible = isVisible;
    if (isVisible) this.#redraw();
  }

  dispose = (): void => {
    for (const end of this.#ends) end();
  };

  #onChange(): void {
    if (this.context.log.entries.length === 0) this.#redraw();
    else if (this.#isVisible) nextFrame(this.#append);
  }

  #addNode(name: string): void {
    if (this.#nodes.has(name)) return;
    this.#nodes.add(name);
    const after = [...this.#node.options].find((option) => option.value !== "" && option.value > name);
    this.#node.add(new Option(name, name), after ?? null);
  }

  #matches(entry: LogEntry): boolean {
    const words = this.#text.value.toLowerCase();
    return entry.level >= Number(this.#level.value) && (!this.#node.value || entry.node === this.#node.value)
      && (!words || entry.text.toLowerCase().includes(words));
  }

  #redraw(): void {
    this.#list.replaceChildren();
    const { log } = this.context;
    this.#shownUpTo = log.total - log.entries.length;
    this.#append();
    this.#follow();
  }

  /** Append the lines since the last time. */
  readonly #append = (): void => {
    const { entries, total } = this.context.log;
    const added = entries.slice(Math.max(0, this.#shownUpTo - (total - entries.length)));
    this.#shownUpTo = total;
    for (const { node } of added) this.#addNode(node);
    const fresh = added.filter((entry) => this.#matches(entry));
    for (const entry of fresh.slice(-MOST_SHOWN)) this.#list.append(lineOf(entry));
    while (this.#list.children.length > MOST_SHOWN) this.#list.firstChild!.remove();
    const isEmpty = this.#list.children.length === 0;
    this.#empty.element.hidden = !isEmpty;
    this.#list.hidden = isEmpty;
    if (entries.length > 0) this.#empty.set("Nothing matches", "No line has this level, node and text.");
    else this.#empty.set("No log lines", "Nodes write here with their logger.");
    setText(this.#count, entries.length > 0 ? String(entries.length) : "");
    if (this.#follows) this.#body.scrollTop = this.#body.scrollHeight;
    else this.#latest.hidden = fresh.length === 0 && this.#latest.hidden;
  };

  #follow(): void {
    this.#follows = true;
    this.#latest.hidden = true;
    this.#body.scrollTop = this.#body.scrollHeight;
  }

  #onScroll(): void {
    const left = this.#body.scrollHeight - this.#body.scrollTop - this.#body.clientHeight;
    this.#follows = left < 24;
    if (this.#follows) this.#latest.hidden = true;
  }

  #save(): void {
    const lines = this.context.log.entries.filter((entry) => this.#matches(entry)).map((entry) => `${stampText(entry.stampNs)} ${levelOf(entry.level).name.toUpperCase()} [${entry.node}] ${entry.text}`);
    download("navette-log.txt", `${lines.join("\n")}\n`, "text/plain");
    this.context.announce(`${lines.length} lines saved`);
  }
}

function levelOf(level: number): (typeof LEVELS)[number] {
  return [...LEVELS].reverse().find(({ least }) => level >= least) ?? LEVELS[0];
}

function lineOf(entry: LogEntry): HTMLElement {
  const level = levelOf(entry.level);
  return h("li", { class: `log-${level.name.toLowerCase()}`, title: entry.place || null },
    h("time", {}, stampText(entry.stampNs)), h("abbr", { title: level.name }, level.short), h("span", { class: "log-node" }, entry.node), h("span", { class: "log-text" }, entry.text));
}

registerPanel({
  id: "log",
  title: "Log",
  icon: "log",
  place: "below",
  hint: "Log lines of all nodes, by level and node.",
  create: (container, context) => new LogPanel(container, context),
});
