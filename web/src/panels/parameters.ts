/** Parameters of every node: sliders with units and ranges, changed while the robot drives. */

import "./parameters.css";
import type { Dispose, ParameterInfo, ParameterValue } from "../connection/connection";
import { h, setText } from "../ui/dom";
import { nextFrame } from "../ui/frames";
import { emptyState } from "./empty";
import { type PanelContext, type PanelInstance, registerPanel } from "./panel";
import { choicesOf, parseValue, rangeOf, unitOf, valueText } from "./parameter_values";

const FIRST = ["/control", "/planner", "/sim"];

interface Row {
  readonly element: HTMLElement;
  readonly input: HTMLInputElement | HTMLSelectElement;
  readonly slider: HTMLInputElement | null;
  readonly refusal: HTMLElement;
  readonly saved: HTMLElement;
}

class ParametersPanel implements PanelInstance {
  readonly #node: HTMLSelectElement;
  readonly #filter: HTMLInputElement;
  readonly #list = h("div", { class: "parameters-list" });
  readonly #empty = emptyState("parameters", "No parameters", "Nodes that declare parameters appear here.");
  readonly #rows = new Map<string, Row>();
  readonly #ends: Dispose[] = [];
  #chosen: string;
  #isVisible = false;

  constructor(
    container: HTMLElement,
    private readonly context: PanelContext,
  ) {
    this.#chosen = context.settings.get<string>("node", "");
    this.#node = h("select", { "aria-label": "Node", class: "topic-select", onchange: () => {
      this.#chosen = this.#node.value;
      context.settings.set("node", this.#chosen);
      this.#rebuild();
    } });
    this.#filter = h("input", { type: "search", placeholder: "Filter", "aria-label": "Filter parameters", class: "grow", oninput: () => this.#rebuild() });
    container.append(h("div", { class: "panel" }, h("div", { class: "bar" }, this.#node, this.#filter),
      h("div", { class: "body", tabindex: "0", role: "region", "aria-label": "Parameters" }, this.#list, this.#empty.element)));
    const { connection } = context;
    this.#ends.push(connection.on("parameters", (names) => this.#onChanged(names)), connection.on("status", () => this.#rebuild()));
    this.#rebuild();
  }

  setVisible(isVisible: boolean): void {
    this.#isVisible = isVisible;
    if (isVisible) this.#rebuild();
  }

  dispose = (): void => {
    for (const end of this.#ends) end();
  };

  #infos(): ParameterInfo[] {
    return [...this.context.connection.parameters.values()].filter(({ name }) => !name.endsWith(".use_sim_time"));
  }

  #onChanged(names: readonly string[]): void {
    if (!this.#isVisible) return;
    const parameters = this.context.connection.parameters;
    const isKnown = names.every((name) => !parameters.has(name) === !this.#rows.has(name) || parameters.get(name)?.node !== this.#shownNode());
    const isTyping = this.#list.contains(document.activeElement);
    if (isKnown && (isTyping || names.every((name) => this.#rows.has(name)))) {
      for (const name of names) this.#show(name);
      if (isTyping) return;
    }
    nextFrame(this.#rebuild);
  }

  #shownNode(): string {
    if (this.#filter.value.trim() && !this.#chosen) return "";
    const nodes = new Set(this.#infos().map(({ node }) => node));
    return this.#chosen || (FIRST.find((name) => nodes.has(name)) ?? [...nodes].sort()[0] ?? "");
  }

  readonly #rebuild = (): void => {
    const infos = this.#infos();
    const nodes = [...new Set(infos.map(({ node }) => node))].sort();
    const node = this.#shownNode();
    const options = nodes.map((name) => new Option(name, name, false, name === node));
    if (node && !nodes.includes(node)) options.push(new Option(`${node} (gone)`, node, true, true));
    this.#node.replaceChildren(...options);
    this.#node.hidden = options.length === 0;
    this.#filter.hidden = options.length === 0;
    const words = this.#filter.value.toLowerCase().split(/\s+/).filter(Boolean);
    const shown = infos
      .filter((info) => info.node === node && words.every((word) => `${info.name} ${info.meaning ?? ""}`.toLowerCase().includes(word)))
      .sort((a, b) => a.name.localeCompare(b.name));
    this.#rows.clear();
    this.#list.replaceChildren(...shown.map((info) => this.#row(info)));
    this.#empty.element.hidden = shown.length > 0;
    if (infos.length > 0) this.#empty.set("Nothing matches", "No parameter of this node contains the filter.");
    else if (this.context.connection.status.state === "live") this.#empty.set("No parameters", "Nodes that declare parameters appear here.");
    else this.#empty.set("Not connected", this.context.connection.status.reason || "Connecting…");
  };

  #row(info: ParameterInfo): HTMLElement {
    const { name, node } = info;
    const short = name.slice(node.length + 1);
    const unit = unitOf(short, info.meaning ?? "");
    const input = this.#input(info);
    const range = typeof info.value === "number" ? rangeOf(info) : null;
    const slider = range && h("input", { type: "range", min: range.low, max: range.high, step: range.step, disabled: info.isReadOnly ?? false, "aria-label": `${name}, slider`,
      oninput: () => { input.value = valueText(Number(slider!.value)); },
      onchange: () => this.#send(name, slider!.value) });
    const refusal = h("p", { class: "hint bad", hidden: true, role: "alert" });
    const saved = h("span", { class: "parameters-saved good", "aria-hidden": "true" }, "set");
    const meaning = (info.meaning ?? "").replace(/ \[[^\]]*\]$/, "");
    const isWide = typeof info.value === "object" || (typeof info.value === "string" && input instanceof HTMLInputElement);
    const limits = info.low !== undefined && info.high !== undefined ? `${valueText(info.low)} … ${valueText(info.high)}` : (info.allowed ?? "").replaceAll(">=", "≥").replaceAll("<=", "≤");
    const notes = [meaning, limits && !(input instanceof HTMLSelectElement) && `Allowed: ${limits}`, info.isReadOnly && "Read only"].filter((text): text is string => Boolean(text));
    const element = h("div", { class: `parameters-row${isWide ? " parameters-wide" : typeof info.value === "boolean" ? " parameters-switch" : ""}` },
      h("div", { class: "parameters-name", title: name }, short, saved),
      h("div", { class: "parameters-value" }, slider, input, unit ? h("span", { class: "parameters-unit quiet" }, unit) : null),
      notes.length > 0 ? h("p", { class: "hint" }, notes.join(" · ")) : null, refusal);
    this.#rows.set(name, { element, input, slider, refusal, saved });
    this.#show(name);
    return element;
  }

  #input(info: ParameterInfo): HTMLInputElement | HTMLSelectElement {
    const { name, value, isReadOnly } = info;
    const choices = typeof value === "string" ? choicesOf(info.allowed ?? "") : null;
    if (choices) {
      const select = h("select", { "aria-label": name, disabled: isReadOnly ?? false, onchange: () => this.#send(name, select.value) });
      select.append(...choices.map((choice) => new Option(choice || "“”", choice)));
      return select;
    }
    const isSwitch = typeof value === "boolean";
    const input = h("input", { type: isSwitch ? "checkbox" : "text", "aria-label": name, disabled: isReadOnly ?? false, spellcheck: "false", autocomplete: "off",
      inputmode: typeof value === "number" ? "decimal" : null,
      onchange: () => this.#send(name, isSwitch ? input.checked : input.value) });
    return input;
  }

  #show(name: string): void {
    const row = this.#rows.get(name);
    const info = this.context.connection.parameters.get(name);
    if (!row || !info || document.activeElement === row.slider) return;
    this.#write(row, info.value);
  }

  #write({ input, slider }: Row, value: ParameterValue): void {
    if (input instanceof HTMLInputElement && input.type === "checkbox") input.checked = value === true;
    else if (document.activeElement !== input || input instanceof HTMLSelectElement) input.value = valueText(value);
    if (slider && typeof value === "number") slider.value = String(value);
  }

  #send(name: string, typed: string | boolean): void {
    const info = this.context.connection.parameters.get(name);
    const row = this.#rows.get(name);
    if (!info || !row) return;
    row.refusal.hidden = true;
    const parsed = parseValue(typed, info.value);
    if (parsed instanceof Error) {
      this.#refuse(row, info, parsed.message);
      return;
    }
    this.context.connection.setParameter(name, parsed).then(
      () => {
        row.saved.classList.add("parameters-shown");
        setTimeout(() => row.saved.classList.remove("parameters-shown"), 1200);
        this.#show(name);
      },
      (error: unknown) => this.#refuse(row, info, error instanceof Error ? error.message : String(error)),
    );
  }

  /** Why it was not set, beside it; the controls return to the value that holds. */
  #refuse(row: Row, info: ParameterInfo, reason: string): void {
    setText(row.refusal, reason);
    row.refusal.hidden = false;
    const current = this.context.connection.parameters.get(info.name)?.value ?? info.value;
    if (document.activeElement === row.input && row.input instanceof HTMLInputElement) row.input.value = valueText(current);
    this.#write(row, current);
  }
}

registerPanel({
  id: "parameters",
  title: "Parameters",
  icon: "parameters",
  place: "right",
  hint: "Parameters of every node, changed while the robot drives.",
  create: (container, context) => new ParametersPanel(container, context),
});
