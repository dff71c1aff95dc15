import { describe, expect, it } from "vitest";
import { pick } from "../src/scene/picking";
import { fromYaw, IDENTITY } from "../src/transforms/transform";

const above = (x: number, y: number): Parameters<typeof pick>[1] => ({ origin: [x, y, 100], direction: [0, 0, -1], metresPerPx: 0.01 });

describe("clicks on the scene", () => {
  it("answer a click with the nearest thing, small ones before large areas, whatever is drawn on top", () => {
    const line = (y: number, fill?: string): object => ({ kind: "lines", mode: "strip", positions: Float32Array.from([0, y, 0, 5, y, 0]), colour: "#000", widthPx: 2, fill });
    const wall = { kind: "solid", shape: "box", pose: { translation: [2, 0, 0.5], rotation: fromYaw(0) }, size: [10, 10, 1], colour: "#000" };
    const robot = { ...wall, size: [0.3, 0.3, 0.3] };
    const sign = { kind: "sign", shape: "cross", pose: { translation: [4, 0.06, 0], rotation: fromYaw(0) }, sizePx: 14, colour: "#000" };
    const [near, far] = [line(0.02), line(0.08)];
    const items = [sign, near, robot, far, wall].map((primitive) => ({ part: { frame: "map", primitives: [primitive] }, fixed_T_part: IDENTITY, opacity: 1 }));
    const found = (x: number, y: number): unknown[] => pick(items as never, above(x, y)).map(({ primitive }) => primitive);
    expect(found(1, 0)).toEqual([near, far, wall]);
    expect(found(4, 0.055)[0]).toBe(sign);
    expect(found(2, -0.04)).toEqual([robot, near, wall]); // in the robot, 6 pixels beside a line
    expect(found(2, 0.02)[0]).toBe(near);
  });

  it("find places within a filled outline, and the edge that closes it", () => {
    const outline = { kind: "lines", mode: "loop", positions: Float32Array.from([0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0]), colour: "#000", widthPx: 2, fill: "#fff" };
    const items = [{ part: { frame: "map", primitives: [outline] }, fixed_T_part: IDENTITY, opacity: 1 }];
    const found = (x: number, y: number): unknown => pick(items as never, above(x, y))[0]?.hit.point;
    expect(found(1, 1)).toEqual([1, 1, 0]);
    expect(found(-0.05, 1)).toEqual([0, 1, 0]);
    expect(found(-0.5, 1)).toBeUndefined();
  });

  it("answer a click from the side with what is in front", () => {
    const crate = (y: number, size: number): object => ({ kind: "solid", shape: "box", pose: { translation: [0, y, 0], rotation: fromYaw(0) }, size: [size, size, size], colour: "#000" });
    const [front, back] = [crate(0, 4), crate(5, 1)];
    const items = [{ part: { frame: "map", primitives: [back, front] }, fixed_T_part: IDENTITY, opacity: 1 }];
    const ray: Parameters<typeof pick>[1] = { origin: [0, -20, 0], direction: [0, 1, 0], metresPerPx: 0.01 };
    expect(pick(items as never, ray).map(({ primitive }) => primitive)).toEqual([front, back]);
  });

  it("find a body from the side where it is, and not a long wall beside the line of sight", () => {
    const wall = { kind: "solid", shape: "box", pose: { translation: [0, -10, 0.5], rotation: fromYaw(0) }, size: [20, 0.3, 1], colour: "#000" } as const;
    const crate = { kind: "solid", shape: "mesh", pose: { translation: [0, 2, 0], rotation: fromYaw(0) }, size: [1, 1, 1], colour: "#000", mesh: { positions: Float32Array.from([-1, -1, 0, 1, -1, 0, 1, 1, 1, -1, 1, 1]) } } as const;
    const items = [{ part: { frame: "map", primitives: [wall, crate] }, fixed_T_part: IDENTITY, opacity: 1 }];
    const towards = (y: number): Parameters<typeof pick>[1] => {
      const length = Math.hypot(20 + y, 20);
      return { origin: [0, -20, 20], direction: [0, (20 + y) / length, -20 / length], metresPerPx: 0.01 };
    };
    const found = (y: number): unknown[] => pick(items as never, towards(y)).map(({ primitive }) => primitive);
    expect(found(2)).toEqual([crate]);
    expect(found(-10)).toEqual([wall]);
    expect(found(-4)).toEqual([]);
  });
});
