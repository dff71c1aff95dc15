/** Occupancy grids and the updates of their cells. */

import { beforeEach, describe, expect, it } from "vitest";
import { RobotState } from "../src/robot/robot_state";
import { DisplayList } from "../src/scene/display_list";
import type { GridUpdate, Header, OccupancyGrid } from "../src/scene/messages";
import { placeOf, type Raster } from "../src/scene/primitives";
import { Theme } from "../src/theme/theme";
import { fromYaw, yawOf } from "../src/transforms/transform";
import { TransformTree } from "../src/transforms/transform_tree";
import { FakeConnection } from "./fake_connection";

describe("displays of grids", () => {
  let connection: FakeConnection;
  let displays: DisplayList;
  let transforms: TransformTree;
  const listOf = (fed: FakeConnection): DisplayList => {
    transforms = new TransformTree();
    const surroundings = { fixedFrame: "map", isThreeDimensional: false, invalidate: (): void => undefined };
    return new DisplayList({ ...surroundings, connection: fed, transforms, theme: new Theme() }, new RobotState(fed, transforms));
  };
  const display = (list = displays): DisplayList["all"][number] => list.all.find(({ id }) => id === "/map")!;
  const at = (sec: number): Header => ({ frame_id: "map", stamp: { sec: Math.floor(sec), nanosec: Math.round((sec % 1) * 1e9) } });
  const pose = { position: { x: -1, y: 2, z: 0 }, orientation: { x: 0, y: 0, z: 0, w: 1 } };
  const update = (sec: number, x: number, y: number, data: number[], width = data.length): GridUpdate =>
    ({ header: at(sec), x, y, width, height: data.length / width, data });
  const whole = (sec: number, data: number[]): OccupancyGrid => 
    ({ header: at(sec), info: { resolution: 0.5, width: 3, height: data.length / 3, origin: pose }, data });
  const raster = (list = displays): Raster => display(list).parts()[0]!.primitives[0] as Raster;
  /** The values of the cells, as a user reads them. */
  const values = (): string[] => {
    const part = display().parts()[0]!;
    return [0, 1, 2, 3, 4, 5].map((index) => part.about!(raster(), { index, point: [0, 0, 0] })[1]![1].split(" ")[0]!);
  };

  beforeEach(() => {
    connection = new FakeConnection();
    displays = listOf(connection);
    connection.addTopic("/map", "nav_msgs/msg/OccupancyGrid");
    connection.addTopic("/map_updates", "map_msgs/msg/OccupancyGridUpdate");
    connection.send("/map", whole(5, [-1, -1, -1, -1, -1, -1]));
  });

  it("are changed by updates, in the raster that is drawn already", () => {
    const drawn = raster();
    connection.send("/map_updates", update(6, 1, 0, [0, 100, 50, 0], 2));
    expect(values()).toEqual(["-1", "0", "100", "-1", "50", "0"]);
    expect(raster()).toBe(drawn);
    expect(drawn.changes).toEqual([{ x: 1, y: 0, width: 2, height: 2 }]);
    const fresh = new FakeConnection();
    const others = listOf(fresh);
    fresh.addTopic("/map", "nav_msgs/msg/OccupancyGrid");
    fresh.send("/map", whole(6, [-1, 0, 100, -1, 50, 0]));
    expect(drawn.pixels).toEqual(raster(others).pixels);
  });

  it("know their bounds after an update", () => {
    expect(display().bounds()).toBeNull();
    connection.send("/map_updates", update(6, 1, 0, [0]));
    expect(display().bounds()).toEqual([-0.5, 2, 0, 2.5]);
    connection.send("/map_updates", update(7, 2, 1, [0]));
    expect(display().bounds()).toEqual([-0.5, 2, 0.5, 3]);
  });

  it("ignore updates from before them, of other frames and beyond them", () => {
    const other = { ...update(9, 0, 0, [7]), header: { ...at(9), frame_id: "odom" } };
    for (const each of [update(5, 0, 0, [7]), update(9, 2, 0, [7, 7]), update(9, 0, 2, [7]), other]) connection.send("/map_updates", each);
    connection.send("/map_updates", { ...update(9, 0, 0, [7]), width: 2 });
    expect(values()).toEqual(["-1", "-1", "-1", "-1", "-1", "-1"]);
  });

  it("keep later updates when a grid is delivered after them", () => {
    connection.send("/map_updates", update(6, 0, 0, [6]));
    connection.send("/map_updates", update(7, 1, 0, [7]));
    connection.send("/map", whole(6, [0, 0, 0, 0, 0, 0]));
    expect(values()).toEqual(["0", "7", "0", "0", "0", "0"]);
  });

  it("forget the updates of another run", () => {
    connection.send("/map_updates", update(7, 1, 0, [7]));
    connection.send("/map", whole(1, [0, 0, 0, 0, 0, 0]));
    expect(values()).toEqual(["0", "0", "0", "0", "0", "0"]);
  });

  it("subscribe to updates only while they are shown", () => {
    expect(connection.isSubscribed("/map_updates")).toBe(true);
    displays.change(display(), { isVisible: false });
    expect(connection.isSubscribed("/map_updates")).toBe(false);
  });

  describe("in a frame that turns", () => {
    const RATE = 0.5; // rad/s
    const turn = (sec: number): void => transforms.set({
      parent: "odom", child: "map", parent_T_child: { translation: [1, 0, 0], rotation: fromYaw(RATE * sec) }, stampNs: BigInt(Math.round(sec * 1e9)), source: "tf",
    });
    /** The time whose transform places the grid. */
    const drawnAt = (): number => yawOf(placeOf(display().parts()[0]!, "odom", transforms)!.rotation) / RATE;
    const frame = (): Promise<number> => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)));

    beforeEach(() => {
      turn(1);
      turn(5);
    });

    it("are drawn where the frame was at their stamp", () => {
      connection.send("/map", whole(4, [0, 0, 0, 0, 0, 0]));
      expect(drawnAt()).toBeCloseTo(4);
      turn(6);
      expect(drawnAt()).toBeCloseTo(4);
    });

    it("wait for the transform of their stamp", async () => {
      const stays = [...values()];
      connection.send("/map", whole(5.5, [9, 9, 9, 9, 9, 9]));
      expect(values()).toEqual(stays);
      expect(drawnAt()).toBeCloseTo(5);
      turn(6);
      await frame();
      expect(values()[0]).toBe("9");
      expect(drawnAt()).toBeCloseTo(5.5);
    });

    it("are moved by an update to where the frame was at its stamp, in the same raster", async () => {
      const drawn = raster();
      connection.send("/map_updates", update(5.4, 0, 0, [6]));
      connection.send("/map_updates", update(5.8, 1, 0, [7]));
      expect(values()[0]).toBe("-1");
      expect(drawnAt()).toBeCloseTo(5);
      turn(5.5);
      await frame();
      expect(values().slice(0, 2)).toEqual(["6", "-1"]);
      expect(drawnAt()).toBeCloseTo(5.4);
      turn(6);
      await frame();
      expect(values().slice(0, 2)).toEqual(["6", "7"]);
      expect(drawnAt()).toBeCloseTo(5.8);
      expect(raster()).toBe(drawn);
    });

    it("lose no update that waits beside them", async () => {
      connection.send("/map_updates", update(5.8, 0, 0, [6]));
      connection.send("/map", whole(5.6, [0, 0, 0, 0, 0, 0]));
      connection.send("/map_updates", update(5.9, 1, 0, [7]));
      turn(6);
      await frame();
      expect(values()).toEqual(["6", "7", "0", "0", "0", "0"]);
      expect(drawnAt()).toBeCloseTo(5.9);
    });

    it("stay in their own frame when that is fixed", () => {
      connection.send("/map", whole(4, [0, 0, 0, 0, 0, 0]));
      expect(placeOf(display().parts()[0]!, "map", transforms)!.rotation).toEqual([0, 0, 0, 1]);
    });
  });
});
