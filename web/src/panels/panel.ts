/** What a panel is, and what it gets. Panels register themselves; the workbench creates them. */

import type { Connection, Dispose } from "../connection/connection";
import type { LogHistory } from "../robot/log_history";
import type { Theme } from "../theme/theme";
import type { TransformTree } from "../transforms/transform_tree";

/** JSON-like settings of one panel instance, saved with the layout. */
export interface Settings {
  get<T>(key: string, otherwise: T): T;
  set(key: string, value: unknown): void;
}

export interface PanelContext {
  readonly connection: Connection;
  readonly transforms: TransformTree;
  readonly theme: Theme;
  readonly log: LogHistory;
  readonly settings: Settings;
  /** Show another panel; a second call focuses it. */
  open(panelId: string, settings?: Record<string, unknown>): void;
  /** Set the tab's title, such as "Plot: speed". */
  setTitle(title: string): void;
  /** A short text to a screen reader and as a passing notice. */
  announce(text: string, level?: "info" | "error"): void;
}

export interface PanelInstance {
  /** The panel came into view or left it: a hidden panel neither draws nor subscribes. */
  setVisible(isVisible: boolean): void;
  /** Undo everything: subscriptions, timers, listeners. */
  dispose: Dispose;
}

export interface PanelKind {
  readonly id: string;
  /** "Topics". */
  readonly title: string;
  /** Name of an icon in `ui/icons.ts`. */
  readonly icon: string;
  /** Where it opens first. */
  readonly place: "left" | "right" | "below";
  /** Several at once, such as plots and images. */
  readonly isMultiple?: boolean;
  /** One sentence for the list of panels. */
  readonly hint: string;
  /** Fill the container, an element that scrolls by itself; `setVisible(true)` follows. */
  create(container: HTMLElement, context: PanelContext): PanelInstance | Promise<PanelInstance>;
}

const kinds = new Map<string, PanelKind>();

export function registerPanel(kind: PanelKind): void {
  if (kinds.has(kind.id)) throw new Error(`panel ${kind.id} is registered twice`);
  kinds.set(kind.id, kind);
}

export function panelKinds(): readonly PanelKind[] {
  return [...kinds.values()];
}

export function panelKind(id: string): PanelKind | undefined {
  return kinds.get(id);
}
