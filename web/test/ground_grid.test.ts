import { expect, test } from "vitest";
import { RobotState } from "../src/robot/robot_state";
import { DisplayList } from "../src/scene/display_list";
import { Theme } from "../src/theme/theme";
import { TransformTree } from "../src/transforms/transform_tree";
import { FakeConnection } from "./fake_connection";

/** How many lines are drawn for a view. */
function linesIn(view: readonly [number, number, number, number, number]): number {
  const [connection, transforms] = [new FakeConnection(), new TransformTree()];
  const around = { fixedFrame: "map", isThreeDimensional: false, invalidate: (): void => undefined, connection, transforms, theme: new Theme() };
  const { grid } = new DisplayList(around, new RobotState(connection, transforms));
  grid.show(view);
  const [lines] = grid.parts()[0]!.primitives;
  return lines?.kind === "lines" ? lines.positions.length / 6 : 0;
}

test("the grid has finitely many lines, also where a step is less than the spacing of numbers", () => {
  expect(linesIn([-1, 0, 2, 1, 0.02])).toBe(6);
  expect(linesIn([1e20, 0, 1e20, 1, 0.02])).toBe(3);
  expect(linesIn([NaN, 0, NaN, 1, 0.02])).toBe(2);
});

test("the grid is drawn in the fixed frame, also when that changes", () => {
  const [connection, transforms] = [new FakeConnection(), new TransformTree()];
  const around = { fixedFrame: "base_link", isThreeDimensional: false, invalidate: (): void => undefined, connection, transforms, theme: new Theme() };
  const { grid } = new DisplayList(around, new RobotState(connection, transforms));
  const view = [-1, -1, 1, 1, 0.02] as const;
  grid.show(view);
  expect(grid.parts()[0]?.frame).toBe("base_link");
  around.fixedFrame = "map";
  grid.show(view);
  expect(grid.parts()[0]?.frame).toBe("map");
});
