import { describe, expect, it } from "vitest";
import { apply, compose, fromRollPitchYaw, fromYaw, IDENTITY, interpolate, inverse, yawOf, type Transform } from "../src/transforms/transform";
import { TransformTree } from "../src/transforms/transform_tree";
import { FakeConnection } from "./fake_connection";

const map_T_odom: Transform = { translation: [1, 2, 0], rotation: fromYaw(Math.PI / 2) };
const odom_T_base: Transform = { translation: [3, 0, 0.5], rotation: fromRollPitchYaw(0.1, -0.2, 0.3) };

function tree(): TransformTree {
  const frames = new TransformTree();
  frames.set({ parent: "map", child: "odom", parent_T_child: map_T_odom, stampNs: 0n, source: "static" });
  frames.set({ parent: "odom", child: "base", parent_T_child: odom_T_base, stampNs: 0n, source: "tf" });
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

describe("interpolation", () => {
  it("turns at a constant rate, the shorter way round", () => {
    const [a, b] = [fromYaw(3), fromYaw(-3)];
    for (const other of [b, b.map((part) => -part) as unknown as typeof b]) {
      const middle = interpolate({ translation: [0, 0, 0], rotation: a }, { translation: [4, 0, -2], rotation: other }, 0.25);
      expect(middle.translation).toEqual([1, 0, -0.5]);
      expect(yawOf(middle.rotation)).toBeCloseTo(3 + 0.25 * (2 * Math.PI - 6));
      expect(Math.hypot(...middle.rotation)).toBeCloseTo(1);
    }
  });

  it("is the same between equal rotations", () => {
    const { rotation } = interpolate(odom_T_base, { ...odom_T_base, translation: [0, 0, 0] }, 0.5);
    rotation.forEach((part, index) => expect(part).toBeCloseTo(odom_T_base.rotation[index]!));
  });
});

describe("the history", () => {
  const turn = (frames: TransformTree, seconds: number, yaw: number, parent = "odom"): void =>
    frames.set({ parent, child: "base", parent_T_child: { translation: [0, 0, 0], rotation: fromYaw(yaw) }, stampNs: BigInt(Math.round(seconds * 1e9)), source: "tf" });
  const yawAt = (frames: TransformTree, seconds: number): [number, number] => {
    const { root_T_frame, lagNs } = frames.placeAt("base", BigInt(Math.round(seconds * 1e9)));
    return [yawOf(root_T_frame.rotation), Number(lagNs) / 1e9];
  };

  it("interpolates at a time, and clamps outside of what it has", () => {
    const frames = new TransformTree();
    for (const index of [0, 2, 1, 3]) turn(frames, 5 + 0.1 * index, 0.2 * index); // one comes late
    expect(yawAt(frames, 5.15)[0]).toBeCloseTo(0.3);
    expect(yawAt(frames, 4)[0]).toBeCloseTo(0);
    expect(yawAt(frames, 5.3)).toEqual([expect.closeTo(0.6), 0]);
    expect(yawAt(frames, 5.8)).toEqual([expect.closeTo(0.6), 0.5]);
    turn(frames, 5.1, 1); // the same stamp again replaces the first
    expect(yawAt(frames, 5.1)[0]).toBeCloseTo(1);
  });

  it("looks every link of a chain up at the time", () => {
    const frames = new TransformTree();
    frames.set({ parent: "base", child: "lidar", parent_T_child: { translation: [1, 0, 0], rotation: fromYaw(0) }, stampNs: 0n, source: "static" });
    for (const [seconds, x] of [[1, 10], [2, 20]] as const) {
      frames.set({ parent: "map", child: "odom", parent_T_child: { translation: [x, 0, 0], rotation: fromYaw(0) }, stampNs: BigInt(seconds * 1e9), source: "tf" });
      turn(frames, 2 * seconds - 1, (seconds - 1) * Math.PI); // stamps 1 and 3
    }
    const { root, root_T_frame, lagNs } = frames.placeAt("lidar", 2_000_000_000n);
    expect([root, lagNs]).toEqual(["map", 0n]);
    [20, 1].forEach((value, axis) => expect(root_T_frame.translation[axis]).toBeCloseTo(value));
    expect(frames.placeAt("lidar", 2_500_000_000n).lagNs).toBe(500_000_000n);
  });

  it("holds ten seconds, and a bounded number of transforms", () => {
    const frames = new TransformTree();
    for (let index = 0; index <= 15; index++) turn(frames, index, 0.1 * index);
    expect(yawAt(frames, 0)[0]).toBeCloseTo(0.5); // the oldest that it has
    for (let index = 1; index <= 5000; index++) turn(frames, 15 + 0.001 * index, 2);
    expect(yawAt(frames, 15.001)[0]).toBeCloseTo(2);
    expect(yawAt(frames, 10)[0]).toBeCloseTo(2);
  });

  it("begins again with another parent, and with stamps from long before", () => {
    const frames = new TransformTree();
    turn(frames, 100, 1);
    turn(frames, 5, 2);
    expect(yawAt(frames, 100)).toEqual([expect.closeTo(2), 95]);
    turn(frames, 6, 0.5, "map");
    expect(yawAt(frames, 5)[0]).toBeCloseTo(0.5);
    expect(frames.root("base")).toBe("map");
  });

  it("forgets what moves when time goes back, and everything with the connection", () => {
    const connection = new FakeConnection();
    const frames = new TransformTree();
    frames.attach(connection);
    const message = (child: string, sec: number): object => ({
      transforms: [{ header: { frame_id: "base", stamp: { sec, nanosec: 0 } }, child_frame_id: child, transform: { translation: { x: sec, y: 0, z: 0 }, rotation: { x: 0, y: 0, z: 0, w: 1 } } }],
    });
    connection.send("/tf", message("arm", 50));
    connection.send("/tf_static", message("lidar", 0));
    connection.emit("reset", { topics: "all" });
    expect(frames.frames).toEqual(["base", "lidar"]);
    connection.send("/tf", message("arm", 48));
    expect(frames.placeAt("arm", 50_000_000_000n).lagNs).toBe(2_000_000_000n);
    connection.emit("status", { state: "lost", reason: "" });
    expect(frames.frames).toEqual([]);
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
    frames.set({ parent: "base", child: "map", parent_T_child: IDENTITY, stampNs: 0n, source: "tf" });
    expect(frames.lookUp("map", "camera")).toBeNull();
  });

  it("reports changes of the structure, not of poses", () => {
    const frames = tree();
    let changes = 0;
    frames.onStructure(() => changes++);
    frames.set({ parent: "odom", child: "base", parent_T_child: IDENTITY, stampNs: 1n, source: "tf" });
    expect(changes).toBe(0);
    frames.set({ parent: "base", child: "lidar", parent_T_child: IDENTITY, stampNs: 1n, source: "static" });
    expect(changes).toBe(1);
    expect(frames.frames).toEqual(["base", "lidar", "map", "odom"]);
    expect(frames.root("lidar")).toBe("map");
  });
});
