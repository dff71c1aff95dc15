import { expect, test } from "vitest";
import { RobotState } from "../src/robot/robot_state";
import { DisplayList } from "../src/scene/display_list";
import { Theme } from "../src/theme/theme";
import { TransformTree } from "../src/transforms/transform_tree";
import { FakeConnection } from "./fake_connection";

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
