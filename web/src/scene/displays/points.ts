/** Measured points: sensor_msgs LaserScan, PointCloud2 and Range. */

import { fixed } from "../../robot/text";
import { boxOf, rampOf, readCloud } from "../cloud_reading";
import type { LaserScan, PointCloud2, Range } from "../messages";
import { faded, type Part } from "../primitives";
import { StampedDisplay } from "../stamped_display";

export class ScanDisplay extends StampedDisplay<LaserScan> {
  #count = 0;

  protected override build(): Part[] {
    const scan = this.message;
    if (!scan) return [];
    const { ranges, angle_min, angle_increment, range_min, range_max } = scan;
    const positions = new Float32Array(3 * ranges.length);
    let count = 0;
    for (let index = 0; index < ranges.length; index++) {
      const range = ranges[index]!;
      if (!(range >= range_min && range <= range_max)) continue;
      const angle = angle_min + index * angle_increment;
      positions[3 * count] = range * Math.cos(angle);
      positions[3 * count + 1] = range * Math.sin(angle);
      count++;
    }
    this.#count = count;
    const points = { kind: "points", positions: positions.subarray(0, 3 * count), colour: this.colour, sizePx: this.size } as const;
    return [{
      frame: scan.header.frame_id,
      primitives: count > 0 ? [points] : [],
      about: (_, { point: [x, y] }) => [
        ["range", `${fixed(Math.hypot(x, y), 3)} m`],
        ["bearing", `${fixed((Math.atan2(y, x) * 180) / Math.PI, 1)}°`],
      ],
    }];
  }

  protected override detail(): string {
    return `${this.#count} of ${this.message?.ranges.length ?? 0} rays hit`;
  }
}

export class CloudDisplay extends StampedDisplay<PointCloud2> {
  #count = 0;
  #box: readonly [number, number, number, number] | null = null;
  #why = "";

  protected override build(): Part[] {
    this.#count = 0;
    this.#box = null;
    this.#why = "";
    const cloud = this.message;
    if (!cloud) return [];
    const { positions, shades, why } = readCloud(cloud, this.choice);
    this.#count = positions.length / 3;
    this.#why = why;
    if (this.#count === 0) return [{ frame: cloud.header.frame_id, primitives: [] }];
    this.#box = boxOf(positions);
    const colours = this.choice === "flat" ? {} : { colours: rampOf(shades) };
    return [{
      frame: cloud.header.frame_id,
      primitives: [{ kind: "points", positions, ...colours, colour: this.colour, sizePx: this.size }],
      about: (_, { point: [x, y, z] }) => [["point", `${fixed(x, 2)}, ${fixed(y, 2)}, ${fixed(z, 2)} m`]],
    }];
  }

  protected override extent(): readonly [number, number, number, number] | null {
    return this.#box;
  }

  protected override detail(): string {
    return this.#why || `${this.#count.toLocaleString("en")} points`;
  }
}

/** A cone from the sensor to what it measured, in the plane. */
export class RangeDisplay extends StampedDisplay<Range> {
  protected override build(): Part[] {
    const value = this.message;
    if (!value) return [];
    const hits = value.range >= value.min_range && value.range <= value.max_range;
    const reach = hits ? value.range : value.max_range;
    if (!Number.isFinite(reach)) return [{ frame: value.header.frame_id, primitives: [] }];
    const rays = 12;
    const positions = new Float32Array(3 * (rays + 2));
    for (let ray = 0; ray <= rays; ray++) {
      const angle = (ray / rays - 0.5) * value.field_of_view;
      positions[3 * ray + 3] = reach * Math.cos(angle);
      positions[3 * ray + 4] = reach * Math.sin(angle);
    }
    const fill = faded(this.colour, hits ? 0.3 : 0.08);
    return [{
      frame: value.header.frame_id,
      primitives: [{ kind: "lines", positions, mode: "loop", colour: faded(this.colour, hits ? 1 : 0.4), widthPx: this.size, fill }],
      about: () => [["range", hits ? `${fixed(value.range, 3)} m` : "nothing in range"]],
    }];
  }

  protected override detail(): string {
    const value = this.message;
    return value && value.range <= value.max_range ? `${fixed(value.range, 2)} m` : "nothing in range";
  }
}
