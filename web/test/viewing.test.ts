import { PerspectiveCamera, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import { boxIn, FIELD_DEG, Viewing } from "../src/scene/viewing";
import { fromYaw } from "../src/transforms/transform";

describe("the view", () => {
  it("fits beside the bars that cover the scene", () => {
    const viewing = new Viewing(() => undefined);
    viewing.fit([0, 0, 10, 10], { width: 400, height: 600, coveredLeft: 62, coveredTop: 0 });
    const { scale, centre: [x, y] } = viewing.viewpoint;
    const pixelOf = (metres: number): number => 200 + (metres - x) * scale;
    expect([pixelOf(0), pixelOf(10)]).toEqual([expect.closeTo(72), expect.closeTo(0.93 * 400)]);
    expect(y).toBeCloseTo(5);
  });

  it("fits a map that is turned against the fixed frame", () => {
    const box = boxIn({ translation: [1, 0, 0], rotation: fromYaw(Math.PI / 2) }, [0, 0, 4, 2]);
    expect(box.map((value) => Number(value.toFixed(6)))).toEqual([-1, 0, 1, 4]);
  });

  it("shows the near corners of the known area in 3D, too", () => {
    for (const [azimuth, elevation] of [[-Math.PI / 2, 0.9], [-0.6, 0.3], [2, 1.5]] as const) {
      const viewing = new Viewing(() => undefined);
      Object.assign(viewing.viewpoint, { azimuth, elevation });
      viewing.fit([-8, -6, 8, 6], { width: 1000, height: 800, coveredLeft: 0, coveredTop: 0 }, true);
      const { scale } = viewing.viewpoint;
      const camera = new PerspectiveCamera(FIELD_DEG, 1000 / 800);
      const farM = 800 / scale / (2 * Math.tan((FIELD_DEG * Math.PI) / 360));
      camera.up.set(0, 0, 1);
      camera.position.set(farM * Math.cos(elevation) * Math.cos(azimuth), farM * Math.cos(elevation) * Math.sin(azimuth), farM * Math.sin(elevation));
      camera.lookAt(0, 0, 0);
      camera.updateMatrixWorld();
      for (const [x, y] of [[-8, -6], [8, -6], [8, 6], [-8, 6]] as const) {
        const place = new Vector3(x, y, 0).project(camera);
        expect(Math.max(Math.abs(place.x), Math.abs(place.y))).toBeLessThan(1);
      }
    }
  });

  it("keeps the place under the pointer while zooming, and the robot while following", () => {
    const viewing = new Viewing(() => undefined);
    viewing.setMode("free");
    viewing.zoom(2, [3, 0]);
    expect(viewing.viewpoint.centre).toEqual([1.5, 0]);
    viewing.setMode("follow");
    viewing.zoom(2, [9, 9]);
    expect(viewing.viewpoint.centre).toEqual([1.5, 0]);
    viewing.pan(1, 1);
    expect(viewing.mode).toBe("free");
  });
});
