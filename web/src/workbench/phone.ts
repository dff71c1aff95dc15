/** Small screens: the scene, and below it one panel at a time in a sheet. */

import { panelKind, panelKinds } from "../panels/panel";
import { h } from "../ui/dom";
import { icon } from "../ui/icons";
import type { Arrangement } from "./dock";
import type { Layout, OpenPanel } from "./layouts";
import { PanelHost, type HostContext } from "./panel_host";

export class Phone implements Arrangement {
  readonly element: HTMLElement;
  readonly #sheet = h("section", { class: "sheet", hidden: true });
  readonly #body = h("div", { class: "sheet-body" });
  readonly #tabs = h("nav", { class: "phone-tabs", "aria-label": "Panels" });
  readonly #hosts = new Map<string, PanelHost>();
  #shown: string | null = null;
  #layout: Pick<Layout, "places" | "open" | "docking"> | null = null;

  constructor(
    scene: HTMLElement,
    private readonly context: HostContext,
  ) {
    this.#sheet.append(this.#body);
    this.element = h("div", { class: "phone" }, scene, this.#sheet, this.#tabs);
  }

  open(kind: string, settings: Record<string, unknown> = {}): void {
    if (!panelKind(kind)) return;
    if (!this.#hosts.has(kind)) this.#hosts.set(kind, new PanelHost(kind, settings, this.context));
    this.#show(kind);
  }

  save(): Pick<Layout, "places" | "open" | "docking"> {
    // A phone changes no docking: the layout of a large screen remains.
    return this.#layout ?? { places: { left: [], right: [], below: [] }, open: [], docking: null };
  }

  restore(layout: Pick<Layout, "places" | "open" | "docking">): void {
    this.#layout = layout;
    this.#close();
    for (const host of this.#hosts.values()) host.dispose();
    this.#hosts.clear();
    for (const { kind, settings } of Object.values(layout.places).flat()) {
      if (!this.#hosts.has(kind)) this.#hosts.set(kind, new PanelHost(kind, { ...settings }, this.context));
    }
    this.#drawTabs(Object.values(layout.places).flat());
  }

  dispose(): void {
    for (const host of this.#hosts.values()) host.dispose();
    this.element.remove();
  }

  #drawTabs(open: readonly OpenPanel[]): void {
    const wanted = [...new Set(open.map(({ kind }) => kind))].flatMap((kind) => panelKind(kind) ?? []);
    const kinds = [...wanted, ...panelKinds().filter((kind) => !wanted.includes(kind))];
    this.#tabs.replaceChildren(
      ...kinds.map(({ id, title, icon: name }) =>
        h("button", { class: "bare", "data-kind": id, "aria-expanded": "false", onclick: () => (this.#shown === id ? this.#close() : this.open(id)) }, icon(name), h("span", {}, title)),
      ),
    );
  }

  #show(kind: string): void {
    if (this.#shown !== null) this.#hosts.get(this.#shown)?.setVisible(false);
    this.#shown = kind;
    const host = this.#hosts.get(kind)!;
    this.#body.replaceChildren(host.element);
    this.#sheet.hidden = false;
    this.#sheet.ariaLabel = panelKind(kind)?.title ?? kind;
    host.setVisible(true);
    this.#drawState();
  }

  #close(): void {
    if (this.#shown !== null) this.#hosts.get(this.#shown)?.setVisible(false);
    this.#shown = null;
    this.#sheet.hidden = true;
    this.#drawState();
  }

  #drawState(): void {
    for (const button of this.#tabs.querySelectorAll<HTMLElement>("[data-kind]")) {
      const isShown = button.dataset["kind"] === this.#shown;
      button.setAttribute("aria-expanded", String(isShown));
      if (isShown) button.scrollIntoView({ block: "nearest", inline: "nearest" });
    }
  }
}
