/** Panels around the scene: left, right, below; dockview moves, splits and collapses them. */

import { createDockview, type DockviewApi, type IContentRenderer, type IDockviewPanel, type IHeaderActionsRenderer } from "dockview";
import "dockview/dist/styles/dockview.css";
import { panelKind } from "../panels/panel";
import { h } from "../ui/dom";
import { icon } from "../ui/icons";
import type { Layout, OpenPanel, Place } from "./layouts";
import { PanelHost, type HostContext } from "./panel_host";

/** What the workbench needs of an arrangement of panels: the dock, or the phone's sheet. */
export interface Arrangement {
  readonly element: HTMLElement;
  open(kind: string, settings?: Record<string, unknown>): void;
  /** Where panels are now. */
  save(): Pick<Layout, "places" | "open" | "docking">;
  restore(layout: Pick<Layout, "places" | "open" | "docking">): void;
  dispose(): void;
}

const SCENE = "scene";
const EDGES = { left: "left", right: "right", below: "bottom" } as const;
const SIZES = { left: 300, right: 380, below: 260 };

export class Dock implements Arrangement {
  readonly element = h("div", { class: "dock" });
  readonly #api: DockviewApi;
  readonly #hosts = new Map<string, PanelHost>();
  #isRestoring = false;

  constructor(
    private readonly scene: HTMLElement,
    private readonly context: HostContext,
  ) {
    this.#api = createDockview(this.element, {
      className: "navette-dock",
      theme: { name: "navette", className: "dockview-theme-navette", edgeGroupCollapsedSize: 36, gap: 0 },
      createComponent: ({ id, name }) => (name === SCENE ? sceneContent(this.scene) : this.#content(id)),
      createTabComponent: ({ id }) => new Tab(this.#hosts.get(id)?.kindId ?? SCENE),
      createRightHeaderActionComponent: () => new CollapseButton(),
      defaultTabComponent: "tab",
      disableFloatingGroups: true,
      announcements: true,
      scrollbars: "native",
    });
    this.#api.onDidLayoutChange(() => {
      if (!this.#isRestoring) this.context.changed();
    });
    this.element.addEventListener("keydown", (event) => {
      const tab = event.target instanceof HTMLElement ? event.target.dataset["tabPanelId"] : undefined;
      if (event.key === "Delete" && tab !== undefined && tab !== SCENE) this.#api.getPanel(tab)?.api.close();
    });
    this.#api.onDidRemovePanel(({ id }) => {
      this.#hosts.get(id)?.dispose();
      this.#hosts.delete(id);
    });
  }

  open(kind: string, settings: Record<string, unknown> = {}): void {
    const known = panelKind(kind);
    if (!known) return;
    const open = this.#api.panels.filter((panel) => this.#hosts.get(panel.id)?.kindId === kind);
    const isNew = known.isMultiple === true && Object.keys(settings).length > 0;
    if (open[0] && !isNew) return this.#focus(open[0]);
    this.#focus(this.#add({ id: this.#freeId(kind), kind, settings }, known.place));
  }

  save(): Pick<Layout, "places" | "open" | "docking"> {
    const places = { left: [] as OpenPanel[], right: [] as OpenPanel[], below: [] as OpenPanel[] };
    for (const panel of this.#api.panels) {
      const host = this.#hosts.get(panel.id);
      if (host) places[placeOf(panel)].push({ id: panel.id, kind: host.kindId, settings: host.settings });
    }
    const open = (Object.keys(EDGES) as Place[]).filter((place) => this.#api.getEdgeGroup(EDGES[place])?.isCollapsed() === false);
    return { places, open, docking: this.#api.toJSON() };
  }

  restore({ places, open, docking }: Pick<Layout, "places" | "open" | "docking">): void {
    this.#isRestoring = true;
    try {
      if (!docking || !this.#restoreExactly(places, docking)) this.#restoreFrom(places, open);
    } finally {
      this.#isRestoring = false;
    }
    this.context.changed();
  }

  dispose(): void {
    this.scene.remove();
    this.#api.dispose();
  }

  #restoreExactly(places: Layout["places"], docking: unknown): boolean {
    this.#clear();
    for (const { id, kind, settings } of Object.values(places).flat()) this.#hosts.set(id, new PanelHost(kind, { ...settings }, this.context));
    try {
      this.#api.fromJSON(docking as Parameters<DockviewApi["fromJSON"]>[0]);
      return this.#api.getPanel(SCENE) !== undefined;
    } catch {
      return false; // of another version of the library: the panels are placed again
    }
  }

  #restoreFrom(places: Layout["places"], open: readonly Place[]): void {
    this.#clear();
    const scene = this.#api.addPanel({ id: SCENE, component: SCENE, title: "Scene" });
    scene.group.header.hidden = true;
    scene.group.locked = "no-drop-target";
    for (const place of Object.keys(EDGES) as Place[]) {
      const added = places[place].filter(({ kind }) => panelKind(kind)).map((panel) => this.#add(panel, place));
      added[0]?.api.setActive();
      const edge = this.#api.getEdgeGroup(EDGES[place]);
      if (open.includes(place)) edge?.expand();
      else edge?.collapse();
    }
    scene.api.setActive();
  }

  #clear(): void {
    this.#api.clear();
    for (const edge of Object.values(EDGES)) if (this.#api.getEdgeGroup(edge)) this.#api.removeEdgeGroup(edge);
    for (const host of this.#hosts.values()) host.dispose();
    this.#hosts.clear();
  }

  #add({ id, kind, settings }: OpenPanel, place: Place): IDockviewPanel {
    const edge = EDGES[place];
    if (!this.#api.getEdgeGroup(edge)) {
      this.#api.addEdgeGroup(edge, { id: `edge-${edge}`, initialSize: SIZES[place], minimumSize: 160, collapsed: true });
    }
    this.#hosts.set(id, new PanelHost(kind, { ...settings }, this.context));
    return this.#api.addPanel({
      id,
      component: kind,
      tabComponent: "tab",
      title: panelKind(kind)?.title ?? kind,
      position: { referenceGroup: `edge-${edge}` },
      inactive: true,
    });
  }

  #focus(panel: IDockviewPanel): void {
    panel.api.setActive();
    if (panel.api.location.type === "edge") panel.group.api.expand();
    // Not a field in it: keys, such as Space for Stop, would go there.
    this.#hosts.get(panel.id)?.element.focus({ preventScroll: true });
  }

  #freeId(kind: string): string {
    let number = 1;
    while (this.#api.getPanel(number === 1 ? kind : `${kind}-${number}`)) number++;
    return number === 1 ? kind : `${kind}-${number}`;
  }

  #content(id: string): IContentRenderer {
    const host = this.#hosts.get(id)!;
    return {
      element: host.element,
      init: ({ api }) => {
        host.onTitle = (title) => api.setTitle(title);
        const update = (): void => host.setVisible(api.isVisible && !api.group.api.isCollapsed());
        api.onDidVisibilityChange(update);
        api.group.api.onDidCollapsedChange(update);
        api.onDidGroupChange(() => {
          api.group.api.onDidCollapsedChange(update);
          update();
        });
        update();
      },
    };
  }
}

function sceneContent(element: HTMLElement): IContentRenderer {
  return { element, init: () => undefined };
}

function placeOf(panel: IDockviewPanel): Place {
  const { location } = panel.api;
  if (location.type !== "edge") return "right"; // docked beside the scene
  return location.position === "left" ? "left" : location.position === "bottom" ? "below" : "right";
}

/** A tab with the panel's icon and a button that closes it. */
class Tab {
  readonly element: HTMLElement;
  readonly #title = h("span", { class: "title" });

  constructor(kind: string) {
    this.element = h("div", { class: "tab" }, icon(panelKind(kind)?.icon ?? "layout"), this.#title);
  }

  init({ api, title }: { api: IDockviewPanel["api"]; title: string }): void {
    this.#title.textContent = title;
    api.onDidTitleChange((event) => (this.#title.textContent = event.title));
    // A tab contains no other control: the sign is the mouse's, the Delete key closes as well.
    const close = h("span", { class: "close", title: `Close ${title} (Delete)`, "aria-hidden": "true" }, icon("close"));
    close.addEventListener("pointerdown", (event) => event.stopPropagation()); // begins no drag
    close.addEventListener("click", (event) => {
      event.stopPropagation();
      api.close();
    });
    this.element.append(close);
    this.element.addEventListener("auxclick", (event) => {
      if (event.button === 1) api.close();
    });
  }
}

/** Collapses the edge that the tabs belong to. */
class CollapseButton {
  readonly element = h("div", { class: "collapse" });

  init({ group: { api: edge } }: Parameters<IHeaderActionsRenderer["init"]>[0]): void {
    const button = h("button", { class: "bare", "aria-label": "Collapse panels", title: "Collapse" });
    const draw = (): void => {
      const { location } = edge;
      this.element.hidden = location.type !== "edge" || edge.isCollapsed();
      if (location.type !== "edge") return;
      button.replaceChildren(icon({ left: "left", right: "right", bottom: "down", top: "up" }[location.position]));
    };
    button.addEventListener("click", () => edge.collapse());
    this.element.append(button);
    edge.onDidCollapsedChange(draw);
    edge.onDidLocationChange(draw);
    draw();
  }

  dispose(): void {
    this.element.remove();
  }
}
