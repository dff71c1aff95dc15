/** nav_msgs/OccupancyGrid: a map, or a costmap with its cost in colour. */

import { Display } from "../display";
import { transformOf, type OccupancyGrid } from "../messages";
import { rgba, type Hit, type Part, type Raster } from "../primitives";

export class GridMapDisplay extends Display<OccupancyGrid> {
  #box: readonly [number, number, number, number] | null = null;
  #isCounted = false;

  protected override take(value: OccupancyGrid): void {
    this.message = value;
    this.#isCounted = false;
  }

  protected override build(): Part[] {
    const grid = this.message;
    if (!grid || grid.info.width * grid.info.height === 0) return [];
    const { width, height, resolution, origin } = grid.info;
    const raster: Raster = {
      kind: "raster",
      pose: transformOf(origin),
      widthM: width * resolution,
      heightM: height * resolution,
      columns: width,
      rows: height,
      pixels: this.#paint(grid),
    };
    return [{ frame: grid.header.frame_id, primitives: [raster], about: (_, hit) => aboutCell(grid, hit) }];
  }

  #paint({ data, info }: OccupancyGrid): Uint8ClampedArray<ArrayBuffer> {
    const table = this.choice === "cost" ? this.#costTable() : this.#mapTable();
    const words = new Uint32Array(info.width * info.height);
    const count = Math.min(words.length, data.length);
    // -1 is unknown: transparent, as all values beyond 100.
    for (let index = 0; index < count; index++) words[index] = table[data[index]! & 255]!;
    return new Uint8ClampedArray(words.buffer);
  }

  /** Free to occupied, as the theme has them. */
  #mapTable(): Uint32Array {
    const free = rgba(this.around.theme.colour("free"));
    const wall = rgba(this.look.colour ?? this.around.theme.colour("wall"));
    return table((cost) => [...mix(free, wall, Math.sqrt(cost / 100)), 255]);
  }

  /** Low cost is faint, inscribed and lethal cells are strong. */
  #costTable(): Uint32Array {
    const low = rgba(this.look.colour ?? this.around.theme.colour("sea"));
    const high = rgba(this.around.theme.colour("mark"));
    const lethal = rgba(this.around.theme.colour("bad"));
    return table((cost) => {
      if (cost === 0) return [0, 0, 0, 0];
      if (cost >= 100) return [lethal[0], lethal[1], lethal[2], 220];
      return [...mix(low, high, cost / 99), 30 + 1.4 * cost];
    });
  }

  /** The known cells only. */
  override bounds(): readonly [number, number, number, number] | null {
    if (!this.message) return null;
    if (!this.#isCounted) {
      this.#box = knownBox(this.message);
      this.#isCounted = true;
    }
    return this.#box;
  }

  protected override detail(): string {
    const info = this.message?.info;
    return info ? `${info.width} × ${info.height} cells of ${Number(info.resolution.toFixed(3))} m` : "";
  }
}

function table(colour: (cost: number) => number[]): Uint32Array {
  const bytes = new Uint8ClampedArray(1024);
  for (let cost = 0; cost <= 100; cost++) bytes.set(colour(cost), 4 * cost);
  return new Uint32Array(bytes.buffer);
}

function mix(a: readonly number[], b: readonly number[], share: number): [number, number, number] {
  const part = (index: number): number => a[index]! + (b[index]! - a[index]!) * share;
  return [part(0), part(1), part(2)];
}

/** Left, low, right and high of the known cells, in metres of the map's frame. */
export function knownBox({ data, info }: OccupancyGrid): readonly [number, number, number, number] | null {
  let [left, right, low, high] = [info.width, -1, info.height, -1];
  for (let row = 0; row < info.height; row++) {
    const begin = row * info.width;
    let first = 0;
    while (first < info.width && data[begin + first]! < 0) first++;
    if (first === info.width) continue;
    let last = info.width - 1;
    while (data[begin + last]! < 0) last--;
    left = Math.min(left, first);
    right = Math.max(right, last);
    low = Math.min(low, row);
    high = row;
  }
  if (right < 0) return null;
  const [x, y] = transformOf(info.origin).translation;
  const size = info.resolution;
  return [x + left * size, y + low * size, x + (right + 1) * size, y + (high + 1) * size];
}

function aboutCell({ data, info }: OccupancyGrid, { index }: Hit): [string, string][] {
  const value = data[index];
  if (value === undefined) return [];
  const meaning = value < 0 ? "unknown" : value === 0 ? "free" : value >= 100 ? "occupied" : `${value} %`;
  return [
    ["cell", `${index % info.width}, ${Math.floor(index / info.width)}`],
    ["value", `${value} (${meaning})`],
  ];
}
