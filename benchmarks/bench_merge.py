"""A rotated 400 x 400 costmap merged into a 2000 x 2000 map, compared with OpenCV (on
the covered region and on the whole map) and SciPy."""

import math

import cv2
import numpy as np
from harness import Benchmark
from scipy.ndimage import affine_transform

from navette.geometry import Pose2
from navette.navigation.grids import GridSpec, merge, placed

RESOLUTION = 0.1
MAP = GridSpec(RESOLUTION, 2000, 2000, Pose2(-100.0, -100.0, 0.0))
GRID = GridSpec(RESOLUTION, 400, 400, Pose2(-20.0, -20.0, 0.0))


def some_costmap(lethal: float) -> np.ndarray:
    rng = np.random.default_rng(0)
    cells = rng.choice(np.array([-1, 0, 0, 40], np.int8), GRID.shape)
    cells[rng.random(GRID.shape) < lethal] = 100
    return cells


class Merge:
    """One costmap at one pose, and the contenders that merge it into the map."""

    def __init__(self, pose: Pose2, lethal: float) -> None:
        self.source = some_costmap(lethal)
        self.spec = placed(GRID, pose)
        # Map cell (u, v) → source cell, for pixel centres at whole numbers.
        source_T_map = self.spec.origin.inverse() @ MAP.origin
        c, s = math.cos(source_T_map.yaw), math.sin(source_T_map.yaw)
        shift = np.array([source_T_map.x, source_T_map.y]) / RESOLUTION
        linear = np.array([[c, -s], [s, c]])
        self.inverse = np.column_stack([linear, linear @ [0.5, 0.5] + shift - 0.5])
        corners = self.spec.origin.apply(
            np.array([(0, 0), (40.0, 0), (0, 40.0), (40.0, 40.0)])
        )
        cells = (corners - (MAP.origin.x, MAP.origin.y)) / RESOLUTION
        self.low = np.floor(cells.min(axis=0)).astype(int)
        self.high = np.ceil(cells.max(axis=0)).astype(int)

    def with_navette(self, target: np.ndarray) -> None:
        merge(target, MAP, self.source, self.spec)

    def with_opencv_region(self, target: np.ndarray) -> None:
        (u0, v0), (u1, v1) = self.low, self.high
        matrix = self.inverse.copy()
        matrix[:, 2] += matrix[:, :2] @ [u0, v0]
        window = target[v0:v1, u0:u1]
        pulled = self._warp(matrix, (int(u1 - u0), int(v1 - v0)))
        np.copyto(window, pulled, where=pulled >= 0)

    def with_opencv_whole(self, target: np.ndarray) -> None:
        pulled = self._warp(self.inverse, (MAP.width, MAP.height))
        np.copyto(target, pulled, where=pulled >= 0)

    def with_scipy_region(self, target: np.ndarray) -> None:
        (u0, v0), (u1, v1) = self.low, self.high
        linear, offset = self.inverse[:, :2], self.inverse[:, 2]
        pulled = affine_transform(
            self.source,
            linear[::-1, ::-1],
            (offset + linear @ [u0, v0])[::-1],
            output_shape=(v1 - v0, u1 - u0),
            order=0,
            cval=-1,
        )
        np.copyto(target[v0:v1, u0:u1], pulled, where=pulled >= 0)

    def _warp(self, matrix: np.ndarray, size: tuple[int, int]) -> np.ndarray:
        flags = cv2.INTER_NEAREST | cv2.WARP_INVERSE_MAP
        return cv2.warpAffine(self.source, matrix, size, flags=flags, borderValue=-1)


def blank() -> np.ndarray:
    return np.full(MAP.shape, -1, np.int8)


def agreement(case: Merge) -> dict[str, float]:
    """Return the share of covered cells in which each peer agrees with Navette."""
    ours = blank()
    case.with_navette(ours)
    covered = blank()
    merge(covered, MAP, np.zeros(GRID.shape, np.int8), case.spec)
    same = {}
    for name in ("opencv region", "opencv whole", "scipy region"):
        theirs = blank()
        getattr(case, f"with_{name.replace(' ', '_')}")(theirs)
        same[name] = float((ours == theirs)[covered == 0].mean())
    return same


def main() -> None:
    cv2.setNumThreads(1)
    bench = Benchmark("merge", __doc__)
    for name, pose, target_ms in (
        ("400² into 2000², rotated", Pose2(3.217, 4.231, 0.6), 0.22),
        ("400² into 2000², straight", Pose2(3.217, 4.231, 0.0), None),
    ):
        # Navette pushes lethal cells (none is lost), unlike the peers: cells are
        # compared without lethal ones, times are measured with as many as in a scan.
        same = agreement(Merge(pose, lethal=0.0))
        assert min(same.values()) > 0.995, same
        case, target = Merge(pose, lethal=0.003), blank()
        bench.case(
            name,
            {
                "navette": lambda case=case, t=target: case.with_navette(t),
                "opencv region": lambda case=case, t=target: case.with_opencv_region(t),
                "scipy region": lambda case=case, t=target: case.with_scipy_region(t),
                "opencv whole": lambda case=case, t=target: case.with_opencv_whole(t),
            },
            ", ".join(f"{100 * v:.2f} % as {k}" for k, v in same.items()),
            target_ms=target_ms,
        )
    bench.main()


if __name__ == "__main__":
    main()
