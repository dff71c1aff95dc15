import { expect, it } from "vitest";
import { SpeedMeter } from "../../src/connection/speed_meter";

it("measures the speed although some samples wait behind slow frames", () => {
  const meter = new SpeedMeter();
  expect(meter.speed).toBeNull();
  for (let tick = 0; tick < 60; tick++) {
    // A frame of a second delays the first samples.
    const arrivalMs = tick < 20 ? 1000 : 50 * tick;
    meter.take(BigInt(50_000_000 * tick), arrivalMs);
  }
  expect(meter.speed).toBeCloseTo(1, 1);
});
