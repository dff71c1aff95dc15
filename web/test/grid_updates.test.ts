/** Occupancy grids and the updates of their cells. */

import { beforeEach, describe, expect, it } from "vitest";
import { RobotState } from "../src/robot/robot_state";
import { DisplayList } from "../src/scene/display_list";
import type { GridUpdate, Header, OccupancyGrid } from "../src/scene/messages";
import type { Raster } from "../src/scene/primitives";
import { Theme } from "../src/theme/theme";
import { TransformTree } from "../src/transforms/transform_tree";
import { FakeConnection } from "./fake_connection";

describe("displays of grids", () => {
  let connection: FakeConnection;
  let displays: DisplayList;
  const listOf = (fed: FakeConnection): DisplayList => {
    const transforms = new TransformTree();
    const surroundings = { fixedFrame: "map", isThreeDimensional: false, invalidate: (): void => undefined };
    return new DisplayList({ ...surroundings, connection: fed, transforms, theme: new Theme() }, new RobotState(fed, transforms));
  };
  const display = (list = displays): DisplayList["all"][number] => list.all.find(({ id }) => id === "/map")!;
  const at = (sec: number): Header => ({ frame_id: "map", stamp: { sec, nanosec: 0 } });
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
});
