/** Transforms of one frame to its parent over time, as tf2 keeps them. */

import { interpolate, type Transform } from "./transform";

export interface Link {
  readonly parent: string;
  readonly child: string;
  readonly parent_T_child: Transform;
  readonly stampNs: bigint;
  /** Odometry serves where no node publishes the transform. */
  readonly source: "tf" | "static" | "odometry";
}

/** As long as tf2's buffer by default. */
const LENGTH_NS = 10_000_000_000n;
const MOST_LINKS = 2000;

export class LinkHistory {
  /** In order of their stamps; one only if it is static. */
  readonly #links: Link[] = [];

  constructor(first: Link) {
    this.#links.push(first);
  }

  get newest(): Link {
    return this.#links.at(-1)!;
  }

  /** Add a transform; one of the same stamp replaces the earlier one. */
  add(link: Link): void {
    const links = this.#links;
    const { parent, source, stampNs } = this.newest;
    // Of another source or parent, or from before the history: a recording began again.
    if (source !== link.source || source === "static" || parent !== link.parent || link.stampNs < stampNs - LENGTH_NS) {
      links.splice(0, links.length, link);
      return;
    }
    const at = this.#countUntil(link.stampNs);
    const isKnown = links[at - 1]?.stampNs === link.stampNs;
    links.splice(isKnown ? at - 1 : at, isKnown ? 1 : 0, link);
    while (links[0]!.stampNs < this.newest.stampNs - LENGTH_NS || links.length > MOST_LINKS) links.shift();
  }

  /** parent_T_child at a time, interpolated; before the first and after the last transform, that one. */
  at(stampNs: bigint): Transform {
    const links = this.#links;
    const count = this.#countUntil(stampNs);
    const [before, after] = [links[count - 1], links[count]];
    if (!before || !after) return (before ?? after)!.parent_T_child;
    const share = Number(stampNs - before.stampNs) / Number(after.stampNs - before.stampNs);
    return interpolate(before.parent_T_child, after.parent_T_child, share);
  }

  /** How much newer a time is than the newest transform; 0 for times that are covered. */
  lagNs(stampNs: bigint): bigint {
    const { source, stampNs: newestNs } = this.newest;
    return source === "static" || stampNs <= newestNs ? 0n : stampNs - newestNs;
  }

  /** Number of transforms not newer than a time; most times are near the end. */
  #countUntil(stampNs: bigint): number {
    const links = this.#links;
    if (stampNs >= this.newest.stampNs) return links.length;
    let [low, high] = [0, links.length - 1];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (links[middle]!.stampNs <= stampNs) low = middle + 1;
      else high = middle;
    }
    return low;
  }
}
