import { beforeEach, describe, expect, it } from "vitest";
import { RobotState } from "../src/robot/robot_state";
import { readCloud } from "../src/scene/cloud_reading";
import { DisplayList } from "../src/scene/display_list";
import type { Surroundings } from "../src/scene/display";
import { knownBox } from "../src/scene/displays/grid_map";
import { readStl } from "../src/scene/displays/meshes";
import { readUrdf } from "../src/scene/displays/models";
import { covarianceEllipse } from "../src/scene/displays/poses";
import { convexHull, isInside } from "../src/scene/hull";
import type { OccupancyGrid, PointCloud2 } from "../src/scene/messages";
import { pick } from "../src/scene/picking";
import { placeOf, rgba, type Primitive } from "../src/scene/primitives";
import { unionOf } from "../src/scene/viewing";
import { Theme } from "../src/theme/theme";
import { apply, fromYaw, IDENTITY, yawOf } from "../src/transforms/transform";
import { TransformTree } from "../src/transforms/transform_tree";
import { FakeConnection } from "./fake_connection";

const header = { frame_id: "map", stamp: { sec: 1, nanosec: 0 } };
const pose = { position: { x: 0, y: 0, z: 0 }, orientation: { x: 0, y: 0, z: 0, w: 1 } };
const grid = (width: number, data: number[]): OccupancyGrid => ({
  header,
  info: { resolution: 0.5, width, height: data.length / width, origin: { ...pose, position: { x: -1, y: 2, z: 0 } } },
  data,
});
const scan = { header: { ...header, frame_id: "lidar" }, angle_min: 0, angle_increment: Math.PI / 2, range_min: 0.1, range_max: 10, ranges: [1, 2, Infinity] };
const above = (x: number, y: number): Parameters<typeof pick>[1] => ({ origin: [x, y, 100], direction: [0, 0, -1], metresPerPx: 0.01 });

describe("displays", () => {
  let connection: FakeConnection;
  let transforms: TransformTree;
  let displays: DisplayList;
  const around = { fixedFrame: "map", isThreeDimensional: false, invalidate: (): void => undefined };
  const display = (id: string): DisplayList["all"][number] => displays.all.find((each) => each.id === id)!;

  beforeEach(() => {
    connection = new FakeConnection();
    transforms = new TransformTree();
    const surroundings: Surroundings = { ...around, connection, transforms, theme: new Theme() };
    displays = new DisplayList(surroundings, new RobotState(connection, transforms));
  });

  it("appear with their topics in a stable order, and leave with them", () => {
    connection.addTopic("/path", "nav_msgs/msg/Path");
    connection.addTopic("/map", "nav_msgs/msg/OccupancyGrid");
    connection.addTopic("/chatter", "std_msgs/msg/String");
    const ids = (): string[] => displays.all.map(({ id }) => id).filter((id) => id.startsWith("/"));
    expect(ids()).toEqual(["/map", "/path"]);
    connection.topics.delete("/map");
    connection.emit("topics", []);
    expect(ids()).toEqual(["/path"]);
  });

  it("subscribe only while they are shown", () => {
    connection.addTopic("/points", "sensor_msgs/msg/PointCloud2");
    expect(connection.isSubscribed("/points")).toBe(false);
    displays.change(display("/points"), { isVisible: true });
    expect(connection.isSubscribed("/points")).toBe(true);
    displays.change(display("/points"), { isVisible: false });
    expect(connection.isSubscribed("/points")).toBe(false);
  });

  it("state why they are empty", () => {
    connection.addTopic("/lidar", "sensor_msgs/msg/LaserScan");
    expect(display("/lidar").status()).toEqual({ level: "empty", text: "no messages yet" });
    connection.send("/lidar", scan);
    expect(display("/lidar").status()).toEqual({ level: "error", text: "no transform from lidar to map" });
    transforms.set({ parent: "map", child: "lidar", parent_T_child: IDENTITY, stampNs: 1_000_000_000n, source: "tf" });
    expect(display("/lidar").status()).toEqual({ level: "ok", text: "2 of 3 rays hit" });
    connection.topics.set("/lidar", { ...connection.topics.get("/lidar")!, type: "std_msgs/msg/String" });
    expect(display("/lidar").status().text).toBe("wrong type: std_msgs/msg/String");
  });

  const marker = (type: number, more: object = {}): object => ({
    header, ns: "", id: type, type, action: 0, pose, scale: { x: 2, y: 0.4, z: 0.2 }, color: { r: 1, g: 0, b: 0, a: 1 }, lifetime: { sec: 0, nanosec: 0 },
    frame_locked: false, points: [], colors: [], text: "", mesh_resource: "", ...more,
  });

  it("draw arrows of markers with a head, and lists as bodies", () => {
    connection.addTopic("/markers", "visualization_msgs/msg/MarkerArray");
    const primitives = (value: object): readonly Primitive[] => {
      connection.send("/markers", { markers: [{ ...marker(0), action: 3 }, value] });
      return display("/markers").parts()[0]!.primitives;
    };
    const tip = ([, head]: readonly Primitive[]): unknown => head?.kind === "solid" && apply(head.pose, [head.size[0], 0, 0]);
    expect(tip(primitives(marker(0)))).toEqual([2, 0, 0]);
    const between = tip(primitives(marker(0, { points: [{ x: 1, y: 1, z: 1 }, { x: 1, y: 4, z: 5 }] }))) as number[];
    expect(between.map((value) => Number(value.toFixed(6)))).toEqual([1, 4, 5]);
    const cubes = primitives(marker(6, { points: [{ x: 1, y: 0, z: 0 }, { x: 2, y: 0, z: 0 }] }));
    expect(cubes.map((each) => each.kind === "solid" && [each.shape, each.pose.translation[0], each.size[0]])).toEqual([["box", 1, 2], ["box", 2, 2]]);
    expect(primitives(marker(8, { points: [{ x: 1, y: 0, z: 0 }] })).map(({ kind }) => kind)).toEqual(["points"]);
  });

  it("state which mesh is missing and why", async () => {
    connection.addTopic("/markers", "visualization_msgs/msg/Marker");
    connection.send("/markers", marker(10, { mesh_resource: "package://arm/meshes/hand.dae" }));
    expect(display("/markers").status()).toEqual({ level: "late", text: "1 marker, no mesh hand.dae: not an STL file" });
    connection.send("/markers", marker(10, { mesh_resource: "package://arm/meshes/hand.stl" }));
    display("/markers").parts();
    await Promise.resolve();
    expect(display("/markers").status().text).toBe("1 marker, no mesh hand.dae: not an STL file, and 1 more");
  });

  it("mark all contacts of a run, also those before the page was opened", () => {
    connection.addTopic("/contacts", "diagnostic_msgs/msg/DiagnosticArray");
    expect(display("/contacts").status()).toEqual({ level: "ok", text: "no contacts" });
    const contact = (count: number, x: number): object => {
      const facts = { frame: "map", x_m: x, y_m: 2, z_m: 0.1, time_s: 4.25, count };
      return { level: 2, name: "sim: contact", message: "robot touched box", values: Object.entries(facts).map(([key, value]) => ({ key, value: String(value) })) };
    };
    connection.send("/contacts", { header, status: [contact(1, 1), contact(2, 3)] });
    const [part] = display("/contacts").parts();
    expect(part?.frame).toBe("map");
    expect(part?.primitives.map((each) => each.kind === "sign" && each.pose.translation)).toEqual([[1, 2, 0.1], [3, 2, 0.1]]);
    expect(part?.about?.(part.primitives[1]!, { point: [3, 2, 0.1], index: 0 })).toEqual([["contact", "robot touched box"], ["at", "4.3 s"]]);
    expect(display("/contacts").status()).toEqual({ level: "ok", text: "2 contacts" });
    connection.send("/contacts", { header, status: [] });
    expect(display("/contacts").parts()).toEqual([]);
    expect(display("/contacts").status()).toEqual({ level: "ok", text: "no contacts" });
  });

  it("name the bodies of a world", () => {
    connection.addTopic("/world_description", "std_msgs/msg/String");
    displays.change(display("/world_description"), { isVisible: true });
    const box = '<visual name="crate"><geometry><box size="1 2 0.456"/></geometry></visual>';
    const post = '<visual><geometry><cylinder radius="0.1" length="3"/></geometry></visual>';
    connection.send("/world_description", { data: `<robot name="hall"><link name="map">${box}${post}</link></robot>` });
    const [part] = display("/world_description").parts();
    const about = part!.primitives.map((primitive) => part!.about?.(primitive, { point: [0, 0, 0], index: 0 }));
    expect(about).toEqual([[["name", "crate"], ["shape", "box, 1 × 2 × 0.46 m"]], [["link", "map"], ["shape", "cylinder, ⌀ 0.2 m, 3 m high"]]]);
    expect(display("/world_description").status().text).toBe("2 shapes");
  });

  it("keep the driven path where it was seen, whatever the map corrects later", () => {
    const correct = (seconds: number, y: number): void =>
      transforms.set({ parent: "map", child: "odom", parent_T_child: { translation: [0, y, 0], rotation: fromYaw(0) }, stampNs: BigInt(seconds) * 1_000_000_000n, source: "tf" });
    const drive = (seconds: number, x: number): void => {
      const twist = { twist: { linear: { x: 0, y: 0, z: 0 }, angular: { x: 0, y: 0, z: 0 } } };
      const moved = { pose: { ...pose, position: { x, y: 0, z: 0 } }, covariance: [] };
      connection.send("/odom", { header: { frame_id: "odom", stamp: { sec: seconds, nanosec: 0 } }, pose: moved, twist });
    };
    const trail = (): number[][] => display("/odom").parts().flatMap((part) => part.primitives.flatMap((each) => {
      if (each.kind !== "lines" || each.mode !== "strip") return [];
      const place = placeOf(part, "map", transforms)!;
      return Array.from({ length: each.positions.length / 3 }, (_, index) => apply(place, [each.positions[3 * index]!, each.positions[3 * index + 1]!, 0]).slice(0, 2));
    }));
    connection.addTopic("/odom", "nav_msgs/msg/Odometry");
    correct(1, 0);
    drive(1, 0);
    drive(2, 0.5);
    correct(3, 0.4);
    drive(3, 1);
    const expected = [[0, 0], [0.5, 0], [1, 0.4]];
    trail().forEach(([x, y], index) => {
      expect(x).toBeCloseTo(expected[index]![0]!);
      expect(y).toBeCloseTo(expected[index]![1]!);
    });
    expect(trail()).toHaveLength(3);
  });

  describe("of a robot that turns", () => {
    const RATE = 1.5; // rad/s
    const wall = { ...scan, ranges: [2, Infinity, Infinity], angle_min: 0 };
    const at = (seconds: number): { sec: number; nanosec: number } => ({ sec: Math.floor(seconds), nanosec: Math.round((seconds % 1) * 1e9) });
    const turn = (seconds: number): void =>
      transforms.set({ parent: "map", child: "lidar", parent_T_child: { translation: [1, 0, 0], rotation: fromYaw(RATE * seconds) }, stampNs: BigInt(Math.round(seconds * 1e9)), source: "tf" });
    const measure = (seconds: number): void => {
      connection.nowNs = BigInt(Math.round(seconds * 1e9));
      connection.send("/lidar", { ...wall, header: { frame_id: "lidar", stamp: at(seconds) } });
    };
    /** Bearings in the map of what is drawn. */
    const drawn = (fixed = "map"): number[] => display("/lidar").parts().map((part) => yawOf(placeOf(part, fixed, transforms)!.rotation));
    const frame = (): Promise<number> => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)));

    beforeEach(() => connection.addTopic("/lidar", "sensor_msgs/msg/LaserScan"));

    it("draw a scan where the robot was at its stamp, whatever comes later", () => {
      for (let index = 0; index <= 10; index++) turn(10 + 0.1 * index);
      measure(10.55); // between two transforms, 0.45 s late
      expect(drawn()).toEqual([expect.closeTo(yawOf(fromYaw(RATE * 10.55)))]);
      for (let index = 1; index <= 300; index++) turn(11 + 0.1 * index); // beyond the history
      expect(drawn()).toEqual([expect.closeTo(yawOf(fromYaw(RATE * 10.55)))]);
      expect(display("/lidar").status().level).toBe("ok");
    });

    it("see it from a frame that moves as it is now", () => {
      turn(10);
      turn(10.2);
      measure(10.1);
      expect(drawn("lidar")).toEqual([expect.closeTo(-RATE * 0.1)]);
    });

    it("hold the newest scan until the transforms reach its stamp", async () => {
      turn(10);
      measure(10);
      measure(10.1);
      measure(10.2);
      expect(drawn()).toEqual([expect.closeTo(yawOf(fromYaw(RATE * 10)))]); // the one before remains
      turn(10.15);
      await frame();
      expect(drawn()).toEqual([expect.closeTo(yawOf(fromYaw(RATE * 10.1)))]);
      turn(10.25);
      await frame();
      expect(drawn()).toEqual([expect.closeTo(yawOf(fromYaw(RATE * 10.2)))]);
    });

    it("draw it at the nearest transform after a second, and report that", () => {
      turn(10);
      measure(10.4);
      expect(display("/lidar").status()).toEqual({ level: "empty", text: "waiting for a transform of lidar" });
      connection.nowNs = 11_300_000_000n;
      connection.emit("time", connection.nowNs);
      expect(drawn()).toEqual([]);
      connection.nowNs = 11_500_000_000n;
      connection.emit("time", connection.nowNs);
      expect(drawn()).toEqual([expect.closeTo(yawOf(fromYaw(RATE * 10)))]);
      expect(display("/lidar").status()).toEqual({ level: "late", text: "the newest transform of lidar is 0.4 s older than the message" });
      measure(13); // too far ahead to wait for
      expect(display("/lidar").status().text).toContain("3.0 s older");
      turn(12.5);
      turn(13.5);
      expect(drawn()).toEqual([expect.closeTo(yawOf(fromYaw(RATE * 13)))]);
    });

    it("take messages without a stamp at the newest transform", () => {
      turn(10);
      measure(0);
      turn(10.5);
      expect(drawn()).toEqual([expect.closeTo(yawOf(fromYaw(RATE * 10.5)))]);
    });

    it("drop what waits when time goes back", async () => {
      turn(10);
      measure(10.5);
      connection.emit("reset", { topics: "all" });
      turn(11);
      await frame();
      expect(drawn()).toEqual([]);
    });

    it("keep each at its own place for its decay, in another fixed frame too", () => {
      displays.change(display("/lidar"), { decayS: 10 });
      for (const seconds of [10, 10.2, 10.4]) {
        turn(seconds);
        measure(seconds);
      }
      expect(drawn()).toEqual([10, 10.2, 10.4].map((seconds) => expect.closeTo(yawOf(fromYaw(RATE * seconds))) as number));
      expect(drawn("lidar")).toEqual([-0.4, -0.2, 0].map((seconds) => expect.closeTo(RATE * seconds) as number));
    });

    it("leave markers where they were, except those that are locked to their frame", () => {
      connection.addTopic("/markers", "visualization_msgs/msg/MarkerArray");
      const marker = (id: number, frame_locked: boolean): object => ({
        header: { frame_id: "lidar", stamp: at(10.1) }, ns: "", id, type: 1, action: 0, pose, scale: { x: 1, y: 1, z: 1 },
        color: { r: 1, g: 0, b: 0, a: 1 }, lifetime: { sec: 0, nanosec: 0 }, frame_locked, points: [], colors: [], text: "", mesh_resource: "",
      });
      turn(10);
      turn(10.2);
      connection.send("/markers", { markers: [marker(1, false), marker(2, true), marker(3, false)] });
      turn(10.4);
      const parts = display("/markers").parts();
      expect(parts.map(({ primitives }) => primitives.length)).toEqual([2, 1]);
      expect(parts.map((part) => yawOf(placeOf(part, "map", transforms)!.rotation))).toEqual([10.1, 10.4].map((seconds) => expect.closeTo(yawOf(fromYaw(RATE * seconds))) as number));
    });
  });

  it("keep messages where they were for their decay", () => {
    connection.addTopic("/lidar", "sensor_msgs/msg/LaserScan");
    transforms.set({ parent: "map", child: "lidar", parent_T_child: IDENTITY, stampNs: 1_000_000_000n, source: "tf" });
    displays.change(display("/lidar"), { decayS: 10 });
    for (let index = 0; index < 3; index++) {
      connection.send("/lidar", scan);
      display("/lidar").parts();
    }
    expect(display("/lidar").parts()).toHaveLength(3);
  });

  it("keep a bounded number of points", () => {
    connection.addTopic("/points", "sensor_msgs/msg/PointCloud2");
    transforms.set({ parent: "map", child: "lidar", parent_T_child: IDENTITY, stampNs: 1_000_000_000n, source: "tf" });
    displays.change(display("/points"), { isVisible: true, decayS: 60 });
    const count = 200_000;
    const cloud: PointCloud2 = {
      header: scan.header, height: 1, width: count, is_bigendian: false, point_step: 12, row_step: 12 * count, data: new Uint8Array(12 * count),
      fields: ["x", "y", "z"].map((name, axis) => ({ name, offset: 4 * axis, datatype: 7, count: 1 })),
    };
    for (let index = 0; index < 9; index++) {
      connection.send("/points", cloud);
      display("/points").parts();
    }
    expect(display("/points").parts()).toHaveLength(6); // five that remain, and the newest
  });

  it("remember their look while the topic is away", () => {
    connection.addTopic("/map", "nav_msgs/msg/OccupancyGrid");
    displays.change(display("/map"), { opacity: 0.3 });
    const topic = connection.topics.get("/map")!;
    connection.topics.delete("/map");
    connection.emit("topics", []);
    connection.addTopic("/map", topic.type);
    expect(display("/map").look.opacity).toBe(0.3);
  });

  it("are found where they are drawn", () => {
    connection.addTopic("/map", "nav_msgs/msg/OccupancyGrid");
    connection.addTopic("/lidar", "sensor_msgs/msg/LaserScan");
    transforms.set({ parent: "map", child: "lidar", parent_T_child: IDENTITY, stampNs: 1_000_000_000n, source: "tf" });
    connection.send("/map", grid(4, [0, 0, 100, -1]));
    connection.send("/lidar", scan);
    const items = displays.all.filter((each) => each !== displays.grid).flatMap((each) => each.parts().map((part) => ({ part, fixed_T_part: IDENTITY, opacity: 1 })));
    const [hit] = pick(items, above(0.01, 2));
    expect(hit?.primitive.kind).toBe("points");
    const cell = pick(items, above(0.25, 2.25)).find(({ primitive }) => primitive.kind === "raster");
    expect(cell?.item.part.about?.(cell.primitive, cell.hit)).toContainEqual(["value", "100 (occupied)"]);
    expect(pick(items, above(0.75, 2.25)).some(({ primitive }) => primitive.kind === "raster")).toBe(false);
  });
});

describe("geometry", () => {
  it("fits known cells only", () => {
    expect(knownBox(grid(3, [-1, -1, -1, -1, 0, 100]))).toEqual([-0.5, 2.5, 0.5, 3]);
    expect(knownBox(grid(2, [-1, -1]))).toBeNull();
    expect(unionOf([[0, 0, 1, 1], [-2, 0.5, 0, 4]])).toEqual([-2, 0, 1, 4]);
  });

  it("makes hulls", () => {
    const hull = convexHull([[0, 0], [2, 0], [2, 2], [0, 2], [1, 1], [1, 0]]);
    expect(hull).toHaveLength(4);
    expect(isInside(hull, [1.5, 1.5])).toBe(true);
    expect(isInside(hull, [2.5, 1])).toBe(false);
  });

  it("draws two deviations", () => {
    const covariance = Array.from({ length: 36 }, (_, index) => (index === 0 ? 4 : index === 7 ? 1 : 0));
    const ellipse = covarianceEllipse(covariance, IDENTITY)!;
    expect(Math.max(...ellipse)).toBeCloseTo(4);
    expect(covarianceEllipse(Array.from({ length: 36 }, () => 0), IDENTITY)).toBeNull();
  });
});

describe("files and messages", () => {
  it("reads a URDF", () => {
    const visuals = readUrdf(
      '<robot><material name="red"><color rgba="1 0 0 1"/></material><link name="base"><visual><origin xyz="1 0 0" rpy="0 0 1.5708"/>' +
        '<geometry><box size="1 2 3"/></geometry><material name="red"/></visual></link><link name="wheel"><visual><geometry><cylinder radius="0.1" length="0.05"/></geometry></visual></link></robot>',
    );
    expect(visuals.map(({ link, shape, size }) => [link, shape, size])).toEqual([["base", "box", [1, 2, 3]], ["wheel", "cylinder", [0.2, 0.2, 0.05]]]);
    expect(rgba(visuals[0]!.colour!)).toEqual([255, 0, 0, 1]);
  });

  it("reads text and binary STL", () => {
    const text = new TextEncoder().encode("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid");
    expect([...readStl(text.buffer).positions]).toEqual([0, 0, 0, 1, 0, 0, 0, 1, 0]);
    const binary = new DataView(new ArrayBuffer(134));
    binary.setUint32(80, 1, true);
    binary.setFloat32(96, 2.5, true);
    expect(readStl(binary.buffer).positions[0]).toBe(2.5);
  });

  it("reads rows of 32-bit numbers in place, wherever the message begins", () => {
    const [width, height, step, rowStep] = [2, 2, 16, 40]; // eight bytes of padding
    for (const shift of [0, 3]) {
      const data = new DataView(new ArrayBuffer(shift + height * rowStep));
      for (let index = 0; index < width * height; index++) {
        const at = shift + Math.floor(index / width) * rowStep + (index % width) * step;
        [index, 10 + index, 20 + index, 30 + index].forEach((value, axis) => data.setFloat32(at + 4 * axis, value, true));
      }
      data.setFloat32(shift + rowStep, Infinity, true);
      const cloud: PointCloud2 = {
        header, height, width, is_bigendian: false, point_step: step, row_step: rowStep, data: new Uint8Array(data.buffer, shift),
        fields: ["x", "y", "z", "intensity"].map((name, axis) => ({ name, offset: 4 * axis, datatype: 7, count: 1 })),
      };
      const { positions, shades } = readCloud(cloud, "intensity");
      expect([...positions]).toEqual([0, 10, 20, 1, 11, 21, 3, 13, 23]);
      expect([...shades]).toEqual([30, 31, 33]);
      const cut = { ...cloud, data: cloud.data.subarray(0, rowStep + step) }; // a message that ends early
      expect([...readCloud(cut, "height").positions]).toEqual([0, 10, 20, 1, 11, 21]);
    }
  });

  it("reads clouds of other layouts, and leaves out what is not finite", () => {
    const data = new DataView(new ArrayBuffer(3 * 20));
    [[1, 2, 3], [NaN, 0, 0], [4, 5, 6]].forEach((point, row) => point.forEach((value, axis) => data.setFloat32(20 * row + 4 + 4 * axis, value, false)));
    const cloud: PointCloud2 = {
      header, height: 1, width: 3, is_bigendian: true, point_step: 20, row_step: 60, data: new Uint8Array(data.buffer),
      fields: ["x", "y", "z"].map((name, axis) => ({ name, offset: 4 + 4 * axis, datatype: 7, count: 1 })),
    };
    expect([...readCloud(cloud, "height").positions]).toEqual([1, 2, 3, 4, 5, 6]);
    expect(readCloud({ ...cloud, fields: [] }, "height").why).toMatch(/no fields/);
  });
});
