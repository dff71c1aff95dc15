import { cardPlace } from "../src/workbench/info_card";
import { beforeEach, describe, expect, it } from "vitest";
import type { ToolContext } from "../src/tools/tool";
import type { Goal } from "../src/robot/robot_state";
import { GoalTool } from "../src/tools/goal";
import { MeasureTool } from "../src/tools/measure";
import { ToolSet } from "../src/tools/tool_set";
import type { Operator } from "../src/robot/operator";
import type { Scene } from "../src/scene/scene";
import { fromYaw } from "../src/transforms/transform";

describe("measuring", () => {
  let tool: MeasureTool;
  const length = (): string | undefined => tool.overlay().flatMap((each) => (each.kind === "label" ? [each.text] : []))[0];
  const click = (x: number, y: number): void => {
    tool.beginDrag([x, y]); // every press may become a drag
    tool.tap([x, y]);
  };

  beforeEach(() => {
    tool = new MeasureTool({ scene: { invalidate: () => undefined }, theme: { colour: () => "#000000" } } as unknown as ToolContext);
  });

  it("adds up the lengths between clicked points", () => {
    click(0, 0);
    expect(length()).toBeUndefined();
    click(3, 4);
    expect(length()).toBe("5.00 m");
    click(3, 6);
    expect(length()).toBe("7.00 m");
  });

  it("measures from where a drag began to where it is", () => {
    click(9, 9);
    tool.beginDrag([0, 0]);
    tool.drag([1, 0]);
    tool.drag([2, 0]);
    expect(length()).toBe("2.00 m");
    tool.endDrag([2.5, 0]);
    expect(length()).toBe("2.50 m");
  });

  it("forgets on escape", () => {
    click(0, 0);
    click(1, 0);
    tool.cancel();
    expect(tool.overlay()).toEqual([]);
  });
});

describe("the goal", () => {
  const sent: Goal[] = [];
  let goal: Goal | null;
  let isStopped = false;
  let state = "live";
  const tool = new GoalTool({
    scene: {
      fixedFrame: "odom",
      connection: { playback: null, get status() { return { state, reason: "" }; } },
      transforms: { lookUp: () => ({ translation: [10, 0, 0], rotation: fromYaw(0) }) },
      robot: { isSubscribed: () => state === "live", get goal() { return goal; }, get isStopped() { return isStopped; } },
      displays: { goal: { isVisible: true } },
      viewing: { viewpoint: { scale: 50 } },
      invalidate: () => undefined,
    },
    operator: { sendGoal: (to: Goal) => sent.push(to) },
    theme: { colour: () => "#000000" },
  } as unknown as ToolContext);

  beforeEach(() => {
    sent.length = 0;
    goal = { frame: "map", x: 1, y: 2, yaw: 1.5 };
  });

  it("is moved by a drag from its mark, and keeps its heading", () => {
    expect(tool.canHold([11.1, 2.1])).toBe(true);
    expect(tool.beginDrag([11.1, 2.1])).toBe(true);
    tool.drag([12, 3]);
    expect(tool.overlay().map((each) => each.kind === "sign" && each.pose.translation)).toEqual([[12, 3, 0], [12, 3, 0]]);
    tool.endDrag([13, 4]);
    expect(sent).toEqual([{ frame: "odom", x: 13, y: 4, yaw: expect.closeTo(1.5) as number }]);
    expect(tool.overlay()).toEqual([]);
  });

  it("is not driven to while the robot is stopped", () => {
    expect(tool.hint).toContain("send the robot there");
    isStopped = true;
    expect(tool.hint).toBe("Click to set the goal; drag the goal to move it.");
    isStopped = false;
  });

  it("names the connection as the obstacle while there is none", () => {
    expect(tool.obstacle).toBe("");
    for (state of ["connecting", "lost"]) expect(tool.obstacle).toBe("Not connected.");
    state = "live";
  });

  it("leaves drags elsewhere to the view", () => {
    expect(tool.beginDrag([11.5, 2])).toBe(false);
    goal = null;
    expect(tool.beginDrag([11, 2])).toBe(false);
  });

  it("stays where it is when the drag is dropped", () => {
    tool.beginDrag([11, 2]);
    tool.drag([15, 2]);
    tool.cancel();
    tool.endDrag([15, 2]);
    expect(sent).toEqual([]);
  });
});

describe("escape", () => {
  it("drops what the chosen tool began and the planned waypoints", () => {
    const scene = {
      element: document.createElement("div"),
      fixedFrame: "map",
      theme: { colour: () => "#000000" },
      invalidate: () => undefined,
      groundAt: (px: number, py: number) => [px, py, 0],
    } as unknown as Scene;
    const tools = new ToolSet(scene, { waypoints: [] } as unknown as Operator);
    tools.choose(tools.waypoints);
    tools.tap(1, 2, false);
    tools.tap(3, 4, false);
    tools.choose(tools.all.find(({ id }) => id === "measure")!);
    tools.tap(5, 6, false);
    expect(scene.overlay()[0]!.primitives).toHaveLength(6); // a line, two marks with numbers, a point
    tools.drop();
    expect(scene.overlay()[0]!.primitives).toEqual([]);
  });
});

describe("the card of what is clicked", () => {
  const card = { width: 264, height: 240 };
  const covers = (press: [number, number], scene: { width: number; height: number }, free: { left: number; top: number; width: number; height: number }): boolean => {
    const { left, top } = cardPlace(press, card, scene, free);
    expect(left).toBeGreaterThanOrEqual(8);
    expect(top).toBeGreaterThanOrEqual(8);
    expect(left + card.width).toBeLessThanOrEqual(scene.width - 8);
    return left + card.width > free.left && top + card.height > free.top;
  };

  it("is beside the press", () => {
    expect(cardPlace([100, 300], card, { width: 1300, height: 780 }, { left: 1000, top: 660, width: 290, height: 110 })).toEqual({ left: 116, top: 280 });
  });

  it.each([
    ["a large screen", { width: 1368, height: 812 }, { left: 1070, top: 700, width: 284, height: 98 }],
    ["a phone", { width: 360, height: 640 }, { left: 190, top: 530, width: 162, height: 102 }],
    ["a phone on its side", { width: 800, height: 260 }, { left: 560, top: 150, width: 230, height: 102 }],
  ])("never covers Stop on %s", (_, scene, free) => {
    for (let px = 10; px < scene.width; px += 50) for (let py = 10; py < scene.height; py += 30) expect(covers([px, py], scene, free)).toBe(false);
  });
});
