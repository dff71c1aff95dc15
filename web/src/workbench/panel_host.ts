/** Creates panels for the dock and the phone: context, settings, visibility, errors. */

import type { Connection } from "../connection/connection";
import { panelKind, type PanelContext, type PanelInstance, type Settings } from "../panels/panel";
import type { LogHistory } from "../robot/log_history";
import type { Theme } from "../theme/theme";
import type { TransformTree } from "../transforms/transform_tree";
import { h } from "../ui/dom";
import { icon } from "../ui/icons";

export interface HostContext {
  readonly connection: Connection;
  readonly transforms: TransformTree;
  readonly theme: Theme;
  readonly log: LogHistory;
  readonly announce: (text: string, level?: "info" | "error") => void;
  readonly open: (kind: string, settings?: Record<string, unknown>) => void;
  /** Settings changed: remember the layout. */
  readonly changed: () => void;
}

/** One open panel, wherever it is docked. */
export class PanelHost {
  readonly element = h("div", { class: "panel-host", tabindex: "-1" });
  onTitle: (title: string) => void = () => undefined;
  #instance: PanelInstance | null = null;
  #isCreated = false;
  #isVisible = false;
  #isGone = false;

  constructor(
    readonly kindId: string,
    readonly settings: Record<string, unknown>,
    private readonly context: HostContext,
  ) {}

  /** Created when it is first seen: a hidden panel costs nothing. */
  setVisible(isVisible: boolean): void {
    if (this.#isVisible === isVisible) return;
    this.#isVisible = isVisible;
    if (isVisible && !this.#isCreated) void this.#create();
    else this.#instance?.setVisible(isVisible);
  }

  dispose(): void {
    this.#isGone = true;
    this.#instance?.dispose();
    this.#instance = null;
  }

  async #create(): Promise<void> {
    this.#isCreated = true;
    const kind = panelKind(this.kindId);
    if (!kind) { this.#show("This panel does not exist", `A saved layout contains ${this.kindId}.`); return; }
    try {
      const instance = await kind.create(this.element, this.#panelContext());
      if (this.#isGone) { instance.dispose(); return; }
      this.#instance = instance;
      instance.setVisible(this.#isVisible);
    } catch (error) {
      this.#show(`${kind.title} cannot be shown`, String(error));
      reportError(error);
    }
  }

  #show(title: string, text: string): void {
    this.element.replaceChildren(h("div", { class: "empty" }, icon("warning"), h("strong", {}, title), h("p", {}, text)));
  }

  #panelContext(): PanelContext {
    const { connection, transforms, theme, log, announce, open } = this.context;
    return { connection, transforms, theme, log, announce, open, settings: this.#settings(), setTitle: (title) => this.onTitle(title) };
  }

  #settings(): Settings {
    const { settings, context } = this;
    return {
      get: <T>(key: string, otherwise: T): T => (key in settings ? (settings[key] as T) : otherwise),
      set: (key, value) => {
        settings[key] = value;
        context.changed();
      },
    };
  }
}
