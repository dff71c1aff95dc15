/** A message as a tree that updates in place; changed values are marked. */

import { h, setText } from "../ui/dom";
import { icon } from "../ui/icons";
import { asNumber } from "./field_path";
import { numberText } from "./format";

const MOST_ITEMS = 50;
const LONGEST_TEXT = 2000;

interface Item {
  readonly element: HTMLLIElement;
  readonly toggle: HTMLButtonElement;
  readonly key: HTMLElement;
  readonly value: HTMLElement;
  readonly plot: HTMLButtonElement;
  list: HTMLUListElement | null;
  readonly items: Map<string, Item>;
  text: string;
  more: HTMLElement | null;
  isBranch: boolean;
}

export interface RawTreeOptions {
  /** A number was chosen, with its path within the message: `.pose.x`. */
  readonly onPlot: (path: string) => void;
}

export class RawTree {
  readonly element = h("ul", { class: "raw-tree" });
  readonly #root: Map<string, Item> = new Map();
  readonly #open = new Set<string>();
  #baseline: unknown;
  #hasBaseline = false;
  #message: unknown;

  constructor(private readonly options: RawTreeOptions) {}

  /** Compare with this message until `compare(null)`: only differing values are shown. */
  compare(baseline: { readonly message: unknown } | null): void {
    this.#hasBaseline = baseline !== null;
    this.#baseline = baseline?.message;
    this.update(this.#message);
  }

  /** Number of values that differ from the baseline. */
  differences = 0;

  update(message: unknown): void {
    this.#message = message;
    this.differences = 0;
    if (message === null || typeof message !== "object") return;
    this.#branch(this.element, this.#root, message, this.#baseline, "", this.#hasBaseline);
  }

  expandAll(depth: number): void {
    const visit = (value: unknown, path: string, left: number): void => {
      if (left === 0 || value === null || typeof value !== "object" || ArrayBuffer.isView(value) || asNumber(value) !== null) return;
      this.#open.add(path);
      for (const [key, child] of entriesOf(value)) visit(child, path + key, left - 1);
    };
    visit(this.#message, "", depth);
    this.update(this.#message);
  }

  collapseAll(): void {
    this.#open.clear();
    this.update(this.#message);
  }

  #branch(list: HTMLUListElement, items: Map<string, Item>, value: object, baseline: unknown, path: string, compares: boolean): number {
    const entries = entriesOf(value);
    const keys = new Set(entries.map(([key]) => key));
    for (const [key, item] of items) {
      if (keys.has(key)) continue;
      item.element.remove();
      items.delete(key);
    }
    let differing = 0;
    entries.forEach(([key, child], index) => {
      let item = items.get(key);
      if (!item) {
        items.set(key, (item = this.#item(key, path + key)));
        list.insertBefore(item.element, list.children[index] ?? null);
      }
      differing += this.#show(item, child, childOf(baseline, key), path + key, compares);
    });
    return differing;
  }

  #show(item: Item, value: unknown, baseline: unknown, path: string, compares: boolean): number {
    const isBranch = value !== null && typeof value === "object" && asNumber(value) === null && lengthOf(value) > 0;
    item.isBranch = isBranch;
    item.toggle.hidden = !isBranch;
    item.plot.hidden = isBranch || asNumber(value) === null;
    let differing = 0;
    if (isBranch) {
      const isOpen = this.#open.has(path) || (compares && !ArrayBuffer.isView(value));
      item.toggle.setAttribute("aria-expanded", String(isOpen));
      if (isOpen) {
        if (!item.list) item.element.append((item.list = h("ul")));
        differing = this.#branch(item.list, item.items, value, baseline, path, compares);
        const hiddenItems = lengthOf(value) - MOST_ITEMS;
        if (hiddenItems > 0 && isList(value)) {
          item.more ??= h("li", { class: "raw-more quiet" });
          setText(item.more, `and ${hiddenItems} more`);
          item.list.append(item.more);
        }
      } else {
        item.list?.remove();
        item.list = null;
        item.items.clear();
        if (compares && textOf(value) !== textOf(baseline)) differing = 1;
      }
      setText(item.value, isOpen ? "" : summaryOf(value));
    } else {
      item.list?.remove();
      item.list = null;
      item.items.clear();
      const text = textOf(value);
      const differs = compares && text !== textOf(baseline);
      if (differs) {
        differing = 1;
        this.differences += 1;
      }
      const shown = differs ? `${textOf(baseline) || "–"} → ${text}` : text;
      if (shown !== item.text) {
        if (item.text && !compares) flash(item.value);
        item.text = shown;
        setText(item.value, shown);
      }
      item.value.className = `raw-value raw-${typeof value}`;
    }
    item.element.classList.toggle("raw-differs", compares && differing > 0 && !isBranch);
    item.element.hidden = compares && differing === 0;
    return differing;
  }

  #item(key: string, path: string): Item {
    const label = key.replace(/^\./, "");
    const switchOver = (): void => {
      if (this.#open.has(path)) this.#open.delete(path);
      else this.#open.add(path);
      this.update(this.#message);
    };
    const toggle = h("button", { class: "bare raw-toggle", "aria-expanded": "false", "aria-label": `Expand ${label}`, onclick: switchOver }, icon("right"));
    const name = h("span", { class: "raw-key", onclick: () => item.isBranch && switchOver() }, label);
    const value = h("span", { class: "raw-value" });
    const plot = h("button", { class: "bare raw-plot", hidden: true, title: "Plot", "aria-label": `Plot ${path.slice(1)}`, onclick: () => this.options.onPlot(path) }, icon("plot"));
    const element = h("li", {}, h("div", { class: "raw-row" }, toggle, name, value, plot));
    const item: Item = { element, toggle, key: name, value, plot, list: null, items: new Map(), text: "", more: null, isBranch: false };
    return item;
  }
}

function isList(value: object): boolean {
  return Array.isArray(value) || ArrayBuffer.isView(value);
}

function lengthOf(value: object): number {
  return isList(value) ? (value as unknown as ArrayLike<unknown>).length : Object.keys(value).length;
}

function entriesOf(value: object): [string, unknown][] {
  if (isList(value)) {
    const list = value as unknown as ArrayLike<unknown>;
    return Array.from({ length: Math.min(list.length, MOST_ITEMS) }, (_, index) => [`[${index}]`, list[index]]);
  }
  return Object.entries(value).map(([name, child]) => [`.${name}`, child]);
}

function childOf(value: unknown, key: string): unknown {
  if (value === null || typeof value !== "object") return undefined;
  return key.startsWith(".") ? (value as Record<string, unknown>)[key.slice(1)] : (value as ArrayLike<unknown>)[Number(key.slice(1, -1))];
}

function summaryOf(value: object): string {
  if (isList(value)) {
    const list = value as unknown as ArrayLike<unknown>;
    const first = Array.from({ length: Math.min(list.length, 6) }, (_, index) => list[index]);
    const isPlain = first.every((each) => each === null || typeof each !== "object");
    return `${list.length} ${list.length === 1 ? "item" : "items"}${isPlain ? `: ${first.map(textOf).join(", ")}${list.length > 6 ? ", …" : ""}` : ""}`;
  }
  const fields = Object.entries(value).map(([name, child]) => (child !== null && typeof child === "object" && asNumber(child) === null ? name : `${name} ${textOf(child)}`));
  return fields.join(", ");
}

export function textOf(value: unknown): string {
  if (value === undefined) return "";
  if (typeof value === "number") return numberText(value, 7);
  if (typeof value === "bigint" || typeof value === "boolean") return String(value);
  if (typeof value === "string") return value.length > LONGEST_TEXT ? `${value.slice(0, LONGEST_TEXT)}…` : value || "“”";
  const time = asNumber(value);
  if (time !== null) return `${numberText(time, 13)} s`;
  if (value !== null && typeof value === "object") return lengthOf(value) === 0 ? "empty" : summaryOf(value);
  return "–";
}

function flash(element: HTMLElement): void {
  if (matchMedia("(prefers-reduced-motion: reduce)").matches) return;
  element.getAnimations().forEach((each) => each.cancel());
  element.animate([{ backgroundColor: "color-mix(in srgb, var(--thread) 22%, transparent)" }, { backgroundColor: "transparent" }], 600);
}
