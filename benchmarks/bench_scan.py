"""Scan insertion: 720 beams traced into a grid, beside OpenCV's and scikit-image's
lines and the plain definition in Python."""

import cv2
import numpy as np
from harness import Benchmark
from skimage.draw import line

from navette.geometry import Pose2
from navette.navigation.grids import GridSpec, beam_directions, trace_beams

BEAMS = 720
RANGE_MAX = 20.0


def some_scan(size_m: float) -> np.ndarray:
    """A cluttered room: ranges of 30 to 95 % of half the grid."""
    rng = np.random.default_rng(0)
    walls = 0.65 + 0.25 * np.sin(np.arange(BEAMS) / 40)
    return (size_m / 2 * walls * rng.uniform(0.95, 1.05, BEAMS)).astype(np.float32)


class Scene:
    """A grid around the sensor and a scan within it."""

    def __init__(self, size_m: float, resolution: float) -> None:
        cells = round(size_m / resolution) + 1
        corner = -cells * resolution / 2
        self.spec = GridSpec(resolution, cells, cells, Pose2(corner, corner, 0.0))
        self.ranges = some_scan(size_m)
        self.directions = beam_directions(-np.pi, 2 * np.pi / BEAMS, BEAMS)
        points = self.directions * self.ranges[:, None].astype(float)
        self.ends = [self.spec.cell_of(x, y) for x, y in points]
        self.start = self.spec.cell_of(0.0, 0.0)

    def blank(self) -> np.ndarray:
        return np.full(self.spec.shape, -1, np.int8)

    def with_navette(self) -> np.ndarray:
        cost = self.blank()
        trace_beams(
            cost,
            self.spec,
            (0.0, 0.0),
            self.directions,
            self.ranges,
            range_min=0.1,
            range_max=RANGE_MAX,
        )
        return cost

    def with_opencv(self) -> np.ndarray:
        cost = self.blank()
        start = self.start[::-1]
        for row, column in self.ends:
            cv2.line(cost, start, (column, row), 0)
        for cell in self.ends:
            cost[cell] = 100
        return cost

    def with_skimage(self) -> np.ndarray:
        cost = self.blank()
        for end in self.ends:
            cost[line(*self.start, *end)] = 0
        for cell in self.ends:
            cost[cell] = 100
        return cost

    def in_python(self) -> np.ndarray:
        cost = self.blank()
        for end in self.ends:
            for cell in bresenham(self.start, end):
                cost[cell] = 0
        for cell in self.ends:
            cost[cell] = 100
        return cost


def bresenham(start: tuple[int, int], end: tuple[int, int]):
    """Return the cells of a line, both ends included."""
    deltas = [abs(b - a) for a, b in zip(start, end, strict=True)]
    steps = [1 if b > a else -1 for a, b in zip(start, end, strict=True)]
    major = 0 if deltas[0] > deltas[1] else 1
    at, error = list(start), deltas[major] // 2
    for _ in range(deltas[major]):
        yield tuple(at)
        at[major] += steps[major]
        error += deltas[1 - major]
        if error >= deltas[major]:
            at[1 - major] += steps[1 - major]
            error -= deltas[major]
    yield tuple(at)


def main() -> None:
    bench = Benchmark("scan insertion", __doc__)
    for size_m, resolution, target_ms in (
        (30.0, 0.1, 0.13),
        (20.0, 0.05, 0.13),
        (30.0, 0.05, None),
    ):
        scene = Scene(size_m, resolution)
        ours = scene.with_navette()
        np.testing.assert_array_equal(ours, scene.in_python())
        others = {"opencv": scene.with_opencv(), "skimage": scene.with_skimage()}
        # The peers break ties between two cells differently.
        same = {who: (ours == cells).mean() for who, cells in others.items()}
        assert min(same.values()) > 0.97, same
        agreement = ", ".join(f"{who} {100 * s:.1f} %" for who, s in same.items())
        bench.case(
            f"{BEAMS} beams, {size_m:g} m at {resolution:g} m",
            {
                "navette": scene.with_navette,
                "opencv": scene.with_opencv,
                "skimage": scene.with_skimage,
                "python": scene.in_python,
            },
            f"same cells as the plain definition; {agreement}",
            target_ms=target_ms,
        )
    bench.main()


if __name__ == "__main__":
    main()
