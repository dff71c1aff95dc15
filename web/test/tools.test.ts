import { beforeEach, describe, expect, it } from "vitest";
import type { ToolContext } from "../src/tools/tool";
import { MeasureTool } from "../src/tools/measure";

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
