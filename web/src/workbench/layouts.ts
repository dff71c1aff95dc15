/** Layouts: which panels are open where, how displays look, how the scene is seen. */

import type { Looks } from "../scene/display_list";
import type { SceneSettings } from "../scene/scene";

export type Place = "left" | "right" | "below";

export interface OpenPanel {
  readonly id: string;
  readonly kind: string;
  readonly settings: Record<string, unknown>;
}

export interface Layout {
  readonly version: 1;
  readonly name: string;
  /** Open panels by place, in order: what a shipped layout states, and what a phone shows. */
  readonly places: Readonly<Record<Place, readonly OpenPanel[]>>;
  /** Places that are open rather than a strip of tabs. */
  readonly open: readonly Place[];
  /** Exact docking as the library serialises it; null: from `places`. */
  readonly docking: unknown;
  readonly looks: Looks;
  readonly scene: SceneSettings;
}

const KEY = "navette.layout";
const PLAIN_SCENE: SceneSettings = { fixedFrame: null, isThreeDimensional: false, mode: "fit" };

/** What most people plot first: commanded and driven speed. */
const SPEEDS = ["/cmd_vel.linear.x", "/odom/filtered.twist.twist.linear.x"];

function panels(...kinds: (string | readonly [string, Record<string, unknown>])[]): OpenPanel[] {
  return kinds.map((each) => {
    const [kind, settings] = typeof each === "string" ? [each, {}] : each;
    return { id: kind, kind, settings };
  });
}

/** The layouts that ship with the page. */
export const SHIPPED: readonly Layout[] = [
  {
    version: 1,
    name: "Drive",
    places: {
      left: panels("displays", "topics", "nodes"),
      right: panels("tree", "parameters", "image"),
      below: panels(["plot", { paths: SPEEDS }], "log", "diagnostics"),
    },
    open: [],
    docking: null,
    looks: {},
    scene: PLAIN_SCENE,
  },
  {
    version: 1,
    name: "Course",
    places: {
      left: panels("displays", "frames", "graph"),
      right: panels(["raw", { topic: "/odom/filtered" }], "parameters", "run"),
      below: panels(["plot", { paths: SPEEDS }], "topics", "log"),
    },
    open: ["left", "right"],
    docking: null,
    looks: { "/costmap": { isVisible: true } },
    scene: PLAIN_SCENE,
  },
  {
    version: 1,
    name: "Recordings",
    places: {
      left: panels("displays", "topics"),
      right: panels("raw", "image", "diagnostics"),
      below: panels(["plot", { paths: SPEEDS }], "log"),
    },
    open: ["below"],
    docking: null,
    looks: {},
    scene: PLAIN_SCENE,
  },
];

export function isLayout(value: unknown): value is Layout {
  const layout = value as Partial<Layout> | null;
  return typeof layout === "object" && layout?.version === 1 && typeof layout.places === "object" && Array.isArray(layout.open);
}

export function rememberLayout(layout: Layout): void {
  try {
    localStorage.setItem(KEY, JSON.stringify(layout));
  } catch {
    // The storage is full or forbidden: the layout lasts as long as the page.
  }
}

export function rememberedLayout(): Layout | null {
  try {
    const value: unknown = JSON.parse(localStorage.getItem(KEY) ?? "null");
    return isLayout(value) ? value : null;
  } catch {
    return null;
  }
}

export function forgetLayout(): void {
  localStorage.removeItem(KEY);
}
