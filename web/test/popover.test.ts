import { describe, expect, it } from "vitest";
import { menuPlace } from "../src/workbench/popover";

const box = (left: number, top: number, width: number, height: number): { left: number; top: number; right: number; bottom: number } => ({ left, top, right: left + width, bottom: top + height });

describe("a menu and Stop", () => {
  const desktop = { width: 1440, height: 900 };
  const [last, stop] = [box(1400, 12, 30, 30), box(1240, 800, 150, 52)];

  it("hangs below its button, within the page", () => {
    expect(menuPlace(last, { width: 300, height: 400 }, desktop, stop)).toEqual({ left: 1130, top: 48, height: 400 });
    expect(menuPlace(box(20, 12, 30, 30), { width: 300, height: 400 }, desktop, stop)).toEqual({ left: 20, top: 48, height: 400 });
  });

  it("stands beside Stop where it would cover it", () => {
    expect(menuPlace(last, { width: 400, height: 790 }, desktop, stop)).toEqual({ left: 824, top: 48, height: 790 });
  });

  it("ends above Stop where there is no room beside it", () => {
    const phone = { width: 360, height: 640 };
    expect(menuPlace(box(320, 8, 32, 40), { width: 340, height: 900 }, phone, box(216, 520, 136, 52))).toEqual({ left: 12, top: 54, height: 450 });
  });

  it("covers its button rather than Stop", () => {
    const phone = { width: 360, height: 740 };
    expect(menuPlace(box(12, 190, 40, 40), { width: 250, height: 260 }, phone, box(216, 270, 136, 52))).toEqual({ left: 12, top: 8, height: 246 });
  });

  it("ignores a Stop that is not displayed", () => {
    expect(menuPlace(last, { width: 400, height: 790 }, desktop, box(0, 0, 0, 0))).toEqual({ left: 1030, top: 48, height: 790 });
  });
});
