/** Wrong messages and errors of a display: reported beside it, without an effect on the others. */

import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { RobotState } from "../src/robot/robot_state";
import { CanvasRenderer } from "../src/scene/canvas_renderer";
import { DisplayList } from "../src/scene/display_list";
import type { OccupancyGrid } from "../src/scene/messages";
import type { Lines } from "../src/scene/primitives";
import type { DrawItem } from "../src/scene/renderer";
import { Theme } from "../src/theme/theme";
import { IDENTITY } from "../src/transforms/transform";
import { TransformTree } from "../src/transforms/transform_tree";
import { FakeConnection } from "./fake_connection";

const reported = vi.fn();

beforeEach(() => vi.stubGlobal("reportError", reported));
afterEach(() => {
  vi.unstubAllGlobals();
  reported.mockClear();
});

describe("displays", () => {
  const header = { frame_id: "map", stamp: { sec: 1, nanosec: 0 } };
  const origin = { position: { x: 0, y: 0, z: 0 }, orientation: { x: 0, y: 0, z: 0, w: 1 } };
  const grid: OccupancyGrid = { header, info: { resolution: 0.5, width: 2, height: 1, origin }, data: [0, 100] };
  let connection: FakeConnection;
  let displays: DisplayList;
  const display = (id: string): DisplayList["all"][number] => displays.all.find((each) => each.id === id)!;

  beforeEach(() => {
    connection = new FakeConnection();
    const transforms = new TransformTree();
    const surroundings = { fixedFrame: "map", isThreeDimensional: false, invalidate: (): void => undefined, connection, transforms, theme: new Theme() };
    displays = new DisplayList(surroundings, new RobotState(connection, transforms));
    connection.addTopic("/map", "nav_msgs/msg/OccupancyGrid");
    connection.send("/map", grid);
  });

  it.each([
    ["a size that its data does not have", { width: 4_000_000, height: 4_000_000 }, "refused: 4000000 × 4000000 cells, but 2 values"],
    ["no resolution", { resolution: 0 }, "refused: the resolution is 0 m, not more than 0"],
    ["an endless resolution", { resolution: Infinity }, "refused: the resolution is Infinity m, not more than 0"],
    ["an origin that is not finite", { origin: { ...origin, position: { x: NaN, y: 0, z: 0 } } }, "refused: the origin is not finite"],
  ])("refuse a grid with %s, and draw the next", (_, wrong, text) => {
    connection.send("/map", { ...grid, info: { ...grid.info, ...wrong } });
    expect(display("/map").bounds()).toBeNull();
    expect(display("/map").parts()).toEqual([]);
    expect(display("/map").status()).toEqual({ level: "error", text });
    display("/map").restyle();
    expect(display("/map").status().text).toBe(text);
    connection.send("/map", grid);
    expect(display("/map").status()).toEqual({ level: "ok", text: "2 × 1 cells of 0.5 m" });
    expect(display("/map").bounds()).toEqual([0, 0, 1, 0.5]);
    expect(reported).not.toHaveBeenCalled();
  });

  it("accept a grid without cells", () => {
    connection.send("/map", { ...grid, info: { ...grid.info, width: 0, height: 0, resolution: 0 }, data: [] });
    expect(display("/map").status().level).toBe("empty");
  });

  it("report an error in a message, once for each", () => {
    connection.addTopic("/poses", "geometry_msgs/msg/PoseArray");
    connection.send("/poses", { header, poses: [{}] });
    for (let frame = 0; frame < 3; frame++) expect(display("/poses").parts()).toEqual([]);
    expect(display("/poses").status().level).toBe("error");
    expect(display("/poses").status().text).toMatch(/^cannot be drawn: /);
    expect(reported).toHaveBeenCalledOnce();
    connection.send("/poses", { header, poses: [origin] });
    expect(display("/poses").status()).toEqual({ level: "ok", text: "1 pose" });
  });

  it("report an error of the renderer, and draw what comes next", () => {
    display("/map").fail(new RangeError("too large"));
    expect(display("/map").parts()).toEqual([]);
    expect(display("/map").bounds()).toBeNull();
    expect(display("/map").status()).toEqual({ level: "error", text: "cannot be drawn: too large" });
    connection.send("/map", grid);
    expect(display("/map").status().level).toBe("ok");
  });

  it("report errors while a message is taken", () => {
    connection.send("/map", { header });
    expect(display("/map").status().level).toBe("error");
    expect(reported).toHaveBeenCalledOnce();
  });
});

describe("the renderer", () => {
  it("draws the other parts when one fails", () => {
    const stroke = vi.fn();
    const context = new Proxy({ stroke }, { get: (target, name) => (name === "stroke" ? target.stroke : () => undefined) });
    const canvas = { getContext: () => context, clientWidth: 100, clientHeight: 100, width: 100, height: 100 };
    const renderer = new CanvasRenderer(canvas as unknown as HTMLCanvasElement);
    const line: Lines = { kind: "lines", positions: new Float32Array(6), mode: "strip", colour: "#000000", widthPx: 1 };
    const fail = vi.fn();
    const item = (primitive: Lines): DrawItem => ({ part: { frame: "map", primitives: [primitive] }, fixed_T_part: IDENTITY, opacity: 1, fail });
    const broken = { ...line, positions: undefined as unknown as Float32Array };
    renderer.draw([item(broken), item(line)], { centre: [0, 0], scale: 40, azimuth: 0, elevation: 1 }, "#ffffff");
    expect(fail).toHaveBeenCalledOnce();
    expect(stroke).toHaveBeenCalledOnce();
  });
});
