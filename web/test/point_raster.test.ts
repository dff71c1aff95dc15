import { beforeEach, describe, expect, it } from "vitest";
import { CUT_BITS, NOTHING, PointRaster } from "../src/scene/point_raster";
import type { Points } from "../src/scene/primitives";

/** A camera at the origin that looks along z: a point is at x/z, y/z of the picture. */
const ALONG_Z = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0];
const [WIDTH, HEIGHT, NEAR] = [9, 5, 0.5];
const points = (positions: number[], colour = "#ff0000", colours?: number[]): Points => ({
  kind: "points", positions: Float32Array.from(positions), colour, sizePx: 1, ...(colours && { colours: Uint8Array.from(colours) }),
});

describe("the raster of points", () => {
  let raster: PointRaster;
  const drawn = (): [column: number, row: number][] =>
    [...raster.words].flatMap((word, index) => (word === NOTHING ? [] : [[index % WIDTH, Math.floor(index / WIDTH)] as [number, number]]));
  const at = (column: number, row: number): number => raster.words[row * WIDTH + column]!;

  beforeEach(() => {
    raster = new PointRaster();
    raster.begin(WIDTH, HEIGHT, NEAR);
  });

  it("puts points where the matrix says, from the lowest row on", () => {
    raster.draw(points([0, 0, 1, -0.99, -0.99, 1, 1.98, 1.98, 2]), ALONG_Z, 1);
    expect(drawn()).toEqual([[0, 0], [4, 2], [8, 4]]);
    expect(raster.hasPoints).toBe(true);
  });

  it("leaves out what is behind, nearer than the least distance, or beside the picture", () => {
    raster.draw(points([0, 0, -1, 0, 0, 0.4, 5, 0, 1, 0, -5, 1, 0, 0, NaN, NaN, 0, 1]), ALONG_Z, 1);
    expect(drawn()).toEqual([]);
  });

  it("draws squares that the edge cuts", () => {
    raster.draw(points([-0.99, -0.99, 1]), ALONG_Z, 3);
    expect(drawn()).toEqual([[0, 0], [1, 0], [0, 1], [1, 1]]);
  });

  it("shows the nearest of several, in whatever order they come", () => {
    for (const order of [[1, 2], [2, 1]]) {
      raster.begin(WIDTH, HEIGHT, NEAR);
      for (const z of order) raster.draw(points([0, 0, z], z === 1 ? "#ff0000" : "#0000ff"), ALONG_Z, 1);
      expect(at(4, 2) & 0xffff).toBe(31 << 11);
    }
  });

  it("keeps distances to 1/4096, as the shader reads them", () => {
    const float = new Float32Array(1);
    const bits = new Uint32Array(float.buffer);
    for (const distance of [NEAR, 1, 7.3, 123.4, 3900]) {
      raster.begin(WIDTH, HEIGHT, NEAR);
      raster.draw(points([0, 0, distance]), ALONG_Z, 1);
      bits[0] = ((at(4, 2) >>> 16) << CUT_BITS) + raster.baseBits;
      expect(Math.abs(float[0]! / distance - 1)).toBeLessThan(1 / 4096);
    }
  });

  it("takes a colour for each point", () => {
    raster.draw(points([0, 0, 1, 0.9, 0, 1], "#000000", [0, 255, 0, 0, 0, 255]), ALONG_Z, 1);
    expect([at(4, 2), at(8, 2)].map((word) => word & 0xffff)).toEqual([63 << 5, 31]);
  });

  it("is clear at the begin of a frame, and of another size", () => {
    raster.draw(points([0, 0, 1]), ALONG_Z, 1);
    raster.begin(WIDTH, HEIGHT, NEAR);
    expect([drawn(), raster.hasPoints]).toEqual([[], false]);
    raster.begin(2, 2, NEAR);
    expect([...raster.words]).toEqual([NOTHING, NOTHING, NOTHING, NOTHING]);
  });
});
