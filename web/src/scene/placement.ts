/**
 * Where a message is drawn: where its frame was at its stamp.
 *
 * What was measured stays where it was in the root of the frames (the map), and the root is seen
 * from the fixed frame as it is now: tf2's lookup between two times. With the root as the fixed
 * frame this is the transform of the stamp, as in RViz.
 */

import { compose, IDENTITY, type Transform } from "../transforms/transform";
import type { Place, TransformTree } from "../transforms/transform_tree";

export class Placement {
  /** Once every transform of the stamp is known. */
  #place: Place | null = null;

  constructor(
    private readonly transforms: TransformTree,
    readonly frame: string,
    /** 0: always the newest transforms. */
    private readonly stampNs: bigint,
  ) {}

  /** How much newer the stamp is than the transforms that are known; 0 if they reach it. */
  get lagNs(): bigint {
    return this.#find()?.lagNs ?? 0n;
  }

  /** fixed_T_frame, with the nearest transforms that are known; null while the frames do not connect. */
  in(fixed: string): Transform | null {
    const place = this.#find();
    if (!place) return this.transforms.lookUp(fixed, this.frame);
    if (place.root === fixed) return place.root_T_frame;
    const fixed_T_root = this.transforms.lookUp(fixed, place.root);
    return fixed_T_root && compose(fixed_T_root, place.root_T_frame);
  }

  #find(): Place | null {
    if (this.stampNs === 0n) return null;
    if (this.#place && this.#place.root === this.transforms.root(this.frame)) return this.#place;
    const place = this.transforms.placeAt(this.frame, this.stampNs);
    this.#place = place.lagNs === 0n ? place : null;
    return place;
  }
}

/** Of a map, which stays in its own frame as in RViz: a correction of that frame moves the map with it. */
export class MapPlacement extends Placement {
  override in(fixed: string): Transform | null {
    return fixed === this.frame ? IDENTITY : super.in(fixed);
  }
}
