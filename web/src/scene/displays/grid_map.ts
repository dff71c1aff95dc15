/**
 * nav_msgs/OccupancyGrid: a map, or a costmap with its cost in colour. Updates of its cells are on
 * `<topic>_updates`, as for RViz: the server sends a large grid whole only if they do not suffice.
 */

import type { Dispose } from "../../connection/connection";
import { nanosecondsOf } from "../../transforms/stamp";
import { transformOf, type GridUpdate, type Header, type OccupancyGrid } from "../messages";
import { MapPlacement, type Placement } from "../placement";
import { rgba, type Hit, type Part, type Patch, type Raster } from "../primitives";
import { StampedDisplay } from "../stamped_display";
import { unionOf, type Box } from "../viewing";

const UPDATE = "map_msgs/msg/OccupancyGridUpdate";
/** Updates that are kept for a grid from before them, which is delivered after them. */
const MOST_KEPT = 20;

interface PlacedUpdate {
  readonly update: GridUpdate;
  readonly placement: Placement;
}

export class GridMapDisplay extends StampedDisplay<OccupancyGrid> {
  #box: Box | null = null;
  #isCounted = false;
  #raster: Raster | null = null;
  #changes: Patch[] = [];
  #updates: PlacedUpdate[] = [];
  #endUpdates: Dispose | null = null;

  override update(): void {
    super.update();
    if (this.topic === null || !this.isVisible) return;
    this.#endUpdates ??= this.around.connection.subscribe<GridUpdate>(`${this.topic}_updates`, { every: true }, (message) => {
      if (message.type === UPDATE) this.attempt(() => this.#takeUpdate(message.value));
    });
  }

  override dispose(): void {
    this.#endUpdates?.();
    this.#endUpdates = null;
    super.dispose();
  }

  override clear(): void {
    this.#updates = [];
    super.clear();
  }

  /** Its size alone may claim more cells than any memory holds. */
  protected override problemOf({ info, data }: OccupancyGrid): string {
    const { width, height, resolution, origin } = info;
    if (width * height !== data.length) return `refused: ${width} × ${height} cells, but ${data.length} values`;
    if (data.length > 0 && !(resolution > 0 && Number.isFinite(resolution))) return `refused: the resolution is ${resolution} m, not more than 0`;
    const { translation, rotation } = transformOf(origin);
    return [...translation, ...rotation].every(Number.isFinite) ? "" : "refused: the origin is not finite";
  }

  protected override take(value: OccupancyGrid): void {
    if (this.message && isBefore(value.header, this.message.header)) this.#updates = []; // another run
    this.message = value;
    this.#raster = null;
    this.#isCounted = false;
    this.#updates = this.#updates.filter(({ update }) => isBefore(value.header, update.header));
    for (const each of this.#updates) this.#change(value, each);
  }

  protected override placementOf({ frame_id: frame, stamp }: Header): Placement {
    return new MapPlacement(this.around.transforms, frame, nanosecondsOf(stamp));
  }

  #takeUpdate(update: GridUpdate): void {
    const placement = this.placementOf(update.header);
    this.whenPlaced(placement, false, () => this.#apply({ update, placement }));
  }

  #apply(placed: PlacedUpdate): void {
    const grid = this.message;
    this.#updates = [...this.#updates, placed].slice(-MOST_KEPT);
    if (!grid || !isBefore(grid.header, placed.update.header)) return;
    this.receivedMs = performance.now();
    this.#change(grid, placed);
    this.around.invalidate();
  }

  /** Change cells in place: a copy of 16 MB would take longer than all else. */
  #change({ header, info, data }: OccupancyGrid, { update, placement }: PlacedUpdate): void {
    const { x, y, width, height } = update;
    const isWithin = x >= 0 && y >= 0 && x + width <= info.width && y + height <= info.height;
    if (header.frame_id !== update.header.frame_id || !isWithin || update.data.length !== width * height) return;
    this.moveTo(placement);
    for (let row = 0; row < height; row++) {
      const begin = (y + row) * info.width + x;
      for (let column = 0; column < width; column++) data[begin + column] = update.data[row * width + column]!;
    }
    if (this.#isCounted) {
      const boxes = [this.#box, knownBox({ info, data }, update)];
      this.#box = unionOf(boxes.filter((each) => each !== null));
    }
    if (!this.#raster) return;
    this.#paint(this.#raster.pixels, { info, data }, update);
    this.#changes.push({ x, y, width, height });
  }

  protected override build(): Part[] {
    const grid = this.message;
    if (!grid || grid.info.width * grid.info.height === 0) return [];
    const { width, height, resolution, origin } = grid.info;
    const pixels = new Uint8ClampedArray(4 * width * height);
    this.#paint(pixels, grid, { x: 0, y: 0, width, height });
    this.#changes = [];
    const raster: Raster = {
      kind: "raster",
      pose: transformOf(origin),
      widthM: width * resolution,
      heightM: height * resolution,
      columns: width,
      rows: height,
      pixels,
      changes: this.#changes,
    };
    this.#raster = raster;
    return [{ frame: grid.header.frame_id, primitives: [raster], about: (_, hit) => aboutCell(grid, hit) }];
  }

  #paint(pixels: Uint8ClampedArray<ArrayBuffer>, { data, info }: Cells, { x, y, width, height }: Patch): void {
    const table = this.choice === "cost" ? this.#costTable() : this.#mapTable();
    const words = new Uint32Array(pixels.buffer);
    for (let row = y; row < y + height; row++) {
      const begin = row * info.width + x;
      const end = Math.min(begin + width, data.length);
      // -1 is unknown: transparent, as all values beyond 100.
      for (let index = begin; index < end; index++) words[index] = table[data[index]! & 255]!;
    }
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
  protected override extent(): Box | null {
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

type Cells = Pick<OccupancyGrid, "info" | "data">;

function isBefore(a: Header, b: Header): boolean {
  return nanosecondsOf(a.stamp) < nanosecondsOf(b.stamp);
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

/** Left, low, right and high of the known cells in a part, in metres of the map's frame. */
export function knownBox({ data, info }: Cells, part: Patch = { x: 0, y: 0, ...info }): Box | null {
  let [left, right, low, high] = [info.width, -1, info.height, -1];
  const end = part.x + part.width;
  for (let row = part.y; row < part.y + part.height; row++) {
    const begin = row * info.width;
    let first = part.x;
    while (first < end && data[begin + first]! < 0) first++;
    if (first === end) continue;
    let last = end - 1;
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
