/** Frames and how they connect: the newest transform of each, from /tf and /tf_static. */

import type { Connection, Dispose } from "../connection/connection";
import { compose, IDENTITY, inverse, type Transform } from "./transform";

export interface Link {
  readonly parent: string;
  readonly child: string;
  readonly parent_T_child: Transform;
  readonly stampNs: bigint;
  readonly isStatic: boolean;
}

interface Stamp {
  sec: number;
  nanosec: number;
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
  readonly #links = new Map<string, Link>();
  readonly #listeners = new Set<() => void>();
  /** Counts changes of any transform: what depends on frames compares it. */
  version = 0;

  /** Child frame → link to its parent. */
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
    this.#listeners.add(callback);
    return () => this.#listeners.delete(callback);
  }

  attach(connection: Connection): Dispose {
    const ends = ["/tf", "/tf_static"].map((topic) =>
      connection.subscribe<{ transforms: TransformStamped[] }>(topic, { every: true }, ({ value }) => {
        for (const each of value.transforms) this.set(linkOf(each, topic === "/tf_static"));
      }),
    );
    ends.push(
      connection.on("status", ({ state }) => {
        if (state === "lost") this.clear();
      }),
    );
    return () => ends.forEach((end) => end());
  }

  set(link: Link): void {
    const before = this.#links.get(link.child);
    this.#links.set(link.child, link);
    this.version += 1;
    if (before?.parent !== link.parent) this.#notify();
  }

  clear(): void {
    this.#links.clear();
    this.version += 1;
    this.#notify();
  }

  /** fixed_T_frame, or null while the frames do not connect. */
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
    return [...this.#ancestors(frame).keys()].at(-1) ?? frame;
  }

  /** Ancestor → ancestor_T_frame, the frame itself first. */
  #ancestors(frame: string): Map<string, Transform> {
    const found = new Map<string, Transform>([[frame, IDENTITY]]);
    let at = frame;
    let link: Link | undefined;
    while ((link = this.#links.get(at)) && !found.has(link.parent)) {
      found.set(link.parent, compose(link.parent_T_child, found.get(at) ?? IDENTITY));
      at = link.parent;
    }
    return found;
  }

  #notify(): void {
    for (const callback of this.#listeners) callback();
  }
}

function linkOf({ header, child_frame_id: child, transform }: TransformStamped, isStatic: boolean): Link {
  const { translation: t, rotation: r } = transform;
  return {
    parent: header.frame_id,
    child,
    parent_T_child: { translation: [t.x, t.y, t.z], rotation: [r.x, r.y, r.z, r.w] },
    stampNs: BigInt(header.stamp.sec) * 1_000_000_000n + BigInt(header.stamp.nanosec),
    isStatic,
  };
}
