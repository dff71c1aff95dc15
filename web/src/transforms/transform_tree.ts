/** Frames and how they connect, now and over the last seconds, from /tf and /tf_static. */

import type { Connection, Dispose } from "../connection/connection";
import { LinkHistory, type Link } from "./link_history";
import { nanosecondsOf, type Stamp } from "./stamp";
import { compose, IDENTITY, inverse, type Transform } from "./transform";

/** A frame at a time. */
export interface Place {
  /** The frame without a parent that the frame hangs from. */
  readonly root: string;
  readonly root_T_frame: Transform;
  /** How much newer the time is than the transforms that are known; 0 if they reach it. */
  readonly lagNs: bigint;
}

interface TransformStamped {
  header: { stamp: Stamp; frame_id: string };
  child_frame_id: string;
  transform: {
    translation: { x: number; y: number; z: number };
    rotation: { x: number; y: number; z: number; w: number };
  };
}

export class TransformTree {
  readonly #histories = new Map<string, LinkHistory>();
  readonly #links = new Map<string, Link>();
  readonly #structureListeners = new Set<() => void>();
  readonly #listeners = new Set<() => void>();

  /** Child frame → newest link to its parent. */
  get links(): ReadonlyMap<string, Link> {
    return this.#links;
  }

  /** All frame names, sorted. */
  get frames(): string[] {
    const names = new Set<string>();
    for (const { parent, child } of this.#links.values()) names.add(parent).add(child);
    return [...names].sort();
  }

  /** Called after frames appear, change their parent or leave; not for every new pose. */
  onStructure(callback: () => void): Dispose {
    this.#structureListeners.add(callback);
    return () => this.#structureListeners.delete(callback);
  }

  /** Called after every new transform. */
  onTransform(callback: () => void): Dispose {
    this.#listeners.add(callback);
    return () => this.#listeners.delete(callback);
  }

  attach(connection: Connection): Dispose {
    const ends = ["/tf", "/tf_static"].map((topic) =>
      connection.subscribe<{ transforms: TransformStamped[] }>(topic, { every: true }, ({ value }) => {
        for (const each of value.transforms) this.set(linkOf(each, topic === "/tf_static" ? "static" : "tf"));
      }),
    );
    ends.push(
      connection.on("status", ({ state }) => {
        if (state === "lost") this.clear();
      }),
      connection.on("reset", ({ topics }) => {
        if (topics === "all") this.clearMoving();
      }),
    );
    return () => ends.forEach((end) => end());
  }

  set(link: Link): void {
    const before = this.#links.get(link.child);
    const history = this.#histories.get(link.child);
    if (history) history.add(link);
    else this.#histories.set(link.child, new LinkHistory(link));
    this.#links.set(link.child, history?.newest ?? link);
    for (const callback of this.#listeners) callback();
    if (before?.parent !== link.parent) this.#notifyStructure();
  }

  clear(): void {
    this.#histories.clear();
    this.#links.clear();
    this.#notifyStructure();
  }

  /** Time went back: what moves is not known any more. */
  clearMoving(): void {
    for (const { child, source } of [...this.#links.values()]) {
      if (source === "static") continue;
      this.#histories.delete(child);
      this.#links.delete(child);
    }
    this.#notifyStructure();
  }

  /** fixed_T_frame of the newest transforms, or null while the frames do not connect. */
  lookUp(fixed: string, frame: string): Transform | null {
    if (fixed === frame) return IDENTITY;
    const up = this.#ancestors(frame);
    const down = this.#ancestors(fixed);
    for (const [name, name_T_frame] of up) {
      const name_T_fixed = down.get(name);
      if (name_T_fixed) return compose(inverse(name_T_fixed), name_T_frame);
    }
    return null;
  }

  /** The frame without a parent that a frame hangs from. */
  root(frame: string): string {
    return this.#chain(frame).at(-1)?.parent ?? frame;
  }

  /** Where a frame was, with the nearest transforms that are known. */
  placeAt(frame: string, stampNs: bigint): Place {
    let place: Place = { root: frame, root_T_frame: IDENTITY, lagNs: 0n };
    for (const { parent, child } of this.#chain(frame)) {
      const history = this.#histories.get(child)!;
      const lagNs = history.lagNs(stampNs);
      place = {
        root: parent,
        root_T_frame: compose(history.at(stampNs), place.root_T_frame),
        lagNs: lagNs > place.lagNs ? lagNs : place.lagNs,
      };
    }
    return place;
  }

  /** Ancestor → ancestor_T_frame, the frame itself first. */
  #ancestors(frame: string): Map<string, Transform> {
    let parent_T_frame = IDENTITY;
    const found = new Map([[frame, parent_T_frame]]);
    for (const { parent, parent_T_child } of this.#chain(frame)) {
      parent_T_frame = compose(parent_T_child, parent_T_frame);
      found.set(parent, parent_T_frame);
    }
    return found;
  }

  /** Links from a frame up to its root; of a loop, each once. */
  #chain(frame: string): Link[] {
    const chain: Link[] = [];
    const seen = new Set([frame]);
    let link: Link | undefined;
    for (let at = frame; (link = this.#links.get(at)) && !seen.has(link.parent); at = link.parent) {
      seen.add(link.parent);
      chain.push(link);
    }
    return chain;
  }

  #notifyStructure(): void {
    for (const callback of this.#structureListeners) callback();
  }
}

function linkOf({ header, child_frame_id: child, transform }: TransformStamped, source: Link["source"]): Link {
  const { translation: t, rotation: r } = transform;
  return {
    parent: header.frame_id,
    child,
    parent_T_child: { translation: [t.x, t.y, t.z], rotation: [r.x, r.y, r.z, r.w] },
    stampNs: nanosecondsOf(header.stamp),
    source,
  };
}
