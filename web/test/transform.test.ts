import { describe, expect, it } from "vitest";
import { apply, compose, fromRollPitchYaw, fromYaw, IDENTITY, inverse, yawOf, type Transform } from "../src/transforms/transform";
import { TransformTree } from "../src/transforms/transform_tree";

const map_T_odom: Transform = { translation: [1, 2, 0], rotation: fromYaw(Math.PI / 2) };
const odom_T_base: Transform = { translation: [3, 0, 0.5], rotation: fromRollPitchYaw(0.1, -0.2, 0.3) };

function tree(): TransformTree {
  const frames = new TransformTree();
  frames.set({ parent: "map", child: "odom", parent_T_child: map_T_odom, stampNs: 0n, isStatic: true });
  frames.set({ parent: "odom", child: "base", parent_T_child: odom_T_base, stampNs: 0n, isStatic: false });
  return frames;
}

describe("transforms", () => {
  it("cancel with their inverse", () => {
    const back = compose(inverse(odom_T_base), odom_T_base);
    [...back.translation, ...back.rotation].forEach((value, index) => expect(value).toBeCloseTo(index === 6 ? 1 : 0));
  });

  it("keep the yaw", () => {
    expect(yawOf(map_T_odom.rotation)).toBeCloseTo(Math.PI / 2);
    expect(yawOf(fromRollPitchYaw(0, 0, -0.7))).toBeCloseTo(-0.7);
  });
});

describe("the tree", () => {
  it("chains frames in both directions", () => {
    const point = apply(tree().lookUp("map", "base")!, [0, 0, 0]);
    [1, 5, 0.5].forEach((value, axis) => expect(point[axis]).toBeCloseTo(value));
    const back = apply(tree().lookUp("base", "map")!, point);
    back.forEach((value) => expect(value).toBeCloseTo(0));
  });

  it("has no transform between frames that do not connect", () => {
    expect(tree().lookUp("map", "camera")).toBeNull();
    expect(tree().lookUp("camera", "camera")).toBe(IDENTITY);
  });

  it("survives a loop of frames", () => {
    const frames = tree();
    frames.set({ parent: "base", child: "map", parent_T_child: IDENTITY, stampNs: 0n, isStatic: false });
    expect(frames.lookUp("map", "camera")).toBeNull();
  });

  it("reports changes of the structure, not of poses", () => {
    const frames = tree();
    let changes = 0;
    frames.onStructure(() => changes++);
    frames.set({ parent: "odom", child: "base", parent_T_child: IDENTITY, stampNs: 1n, isStatic: false });
    expect(changes).toBe(0);
    frames.set({ parent: "base", child: "lidar", parent_T_child: IDENTITY, stampNs: 1n, isStatic: true });
    expect(changes).toBe(1);
    expect(frames.frames).toEqual(["base", "lidar", "map", "odom"]);
    expect(frames.root("lidar")).toBe("map");
  });
});
