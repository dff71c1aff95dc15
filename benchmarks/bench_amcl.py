"""Global localization: unknown start poses in generated worlds of several rooms.

The robot drives towards open space by its scanner alone while AMCL localizes. A start
counts as right if, after the time limit, the robot is ``localized`` within 0.3 m and 10
degrees of the true pose.

    python benchmarks/bench_amcl.py --starts 100 --seconds 30
"""

import argparse
import json
import math
import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Pose2, angle_difference
from navette.navigation.grids import GridSpec
from navette.navigation.localization.amcl import AmclParams
from navette.navigation.localization.amcl.confidence import LocalizationState
from navette.navigation.localization.amcl.localizer import MapLocalizer, ScanView
from navette.navigation.worlds.generators import generate
from navette.sim import SimParams, load_robot
from navette.sim.simulator import Simulator

SCAN_NS = 100_000_000
WORLDS = ("rooms", "office")
RIGHT_M, RIGHT_RAD = 0.3, math.radians(10.0)
RESOLUTION_M = 0.05
CRUISE_MPS, TURN_RADPS = 0.7, 1.2
BODY_M, NARROW_M = 0.4, 0.28  # half widths that should and must be free
KEPT_NS = 5_000_000_000


@dataclass(frozen=True)
class Outcome:
    """One start: whether the pose is right, since when, and what it cost."""

    world: str
    right: bool
    state: str
    error_m: float
    since_s: float
    driven_m: float
    cpu_share: float


def rasterized(simulator: Simulator) -> tuple[NDArray[np.int8], GridSpec]:
    """Return the true map (H, W) of a world, 0 free, 100 occupied."""
    outlines = simulator.outlines()
    points = np.concatenate(outlines)
    low, high = points.min(axis=0) - 0.5, points.max(axis=0) + 0.5
    width, height = np.ceil((high - low) / RESOLUTION_M).astype(int).tolist()
    spec = GridSpec(RESOLUTION_M, width, height, Pose2(low[0], low[1], 0.0))
    cells = np.zeros(spec.shape, np.int8)
    for outline in outlines:
        fill(cells, (outline - low) / RESOLUTION_M)
    return cells, spec


def fill(cells: NDArray[np.int8], corners: NDArray[np.float64]) -> None:
    """Mark the cells whose centres lie in a convex polygon (N, 2), in cells."""
    first = np.maximum(np.floor(corners.min(axis=0)).astype(int) - 1, 0)
    last = np.ceil(corners.max(axis=0)).astype(int) + 1
    x, y = np.meshgrid(
        np.arange(first[0], min(last[0], cells.shape[1])) + 0.5,
        np.arange(first[1], min(last[1], cells.shape[0])) + 0.5,
    )
    edges = np.roll(corners, -1, axis=0) - corners
    sides = [
        dx * (y - cy) - dy * (x - cx)
        for (cx, cy), (dx, dy) in zip(corners, edges, strict=True)
    ]
    inside = np.all(np.array(sides) >= -0.5, axis=0)
    inside |= np.all(np.array(sides) <= 0.5, axis=0)
    region = cells[
        first[1] : first[1] + inside.shape[0], first[0] : first[0] + inside.shape[1]
    ]
    region[inside] = 100


class Wanderer:
    """Drives to where a scan is open, and turns only where the path ends.

    A direction is kept for some time: one chosen at every scan alternates between
    two that are alike, and the robot stays where it is.
    """

    def __init__(self) -> None:
        self._target: float | None = None  # heading in the odometry's frame, rad
        self._until_ns = 0

    def command(
        self,
        angles: NDArray[np.float64],
        ranges: NDArray[np.float64],
        yaw: float,
        now_ns: int,
    ) -> tuple[float, float]:
        """Return speed (m/s) and turn rate (rad/s)."""
        if self._target is None or now_ns >= self._until_ns:
            self._target = yaw + self._widest(angles, ranges)
            self._until_ns = now_ns + KEPT_NS
        off = angle_difference(self._target, yaw)
        ahead = open_m(angles, ranges, 0.0, NARROW_M)
        if abs(off) < 0.3 and ahead < 0.6:
            self._until_ns = now_ns
        turn = float(np.clip(2.0 * off, -TURN_RADPS, TURN_RADPS))
        speed = CRUISE_MPS * min(1.0, max(0.0, ahead - 0.4) / 0.6)
        return speed * max(0.0, math.cos(off)) ** 4, turn

    def _widest(
        self, angles: NDArray[np.float64], ranges: NDArray[np.float64]
    ) -> float:
        """Return the best direction, ahead before behind."""
        headings = np.radians(np.arange(-170, 181, 10))
        kept = 1.0 - 0.5 * np.abs(headings) / math.pi
        for half_m in (BODY_M, NARROW_M):
            free = np.array([open_m(angles, ranges, each, half_m) for each in headings])
            if free.max() > 1.0:
                break
        return float(headings[int(np.argmax(np.minimum(free, 6.0) * kept))])


def open_m(
    angles: NDArray[np.float64],
    ranges: NDArray[np.float64],
    heading: float,
    half_m: float,
) -> float:
    """Return how far a body of a half width can move in a direction."""
    along, across = ranges * np.cos(angles - heading), ranges * np.sin(angles - heading)
    hits = (along > 0) & (np.abs(across) < half_m)
    return float(along[hits].min(initial=10.0))


def run(kind: str, world: int, seed: int, seconds: float) -> Outcome:
    """Drive from a random pose of a world."""
    rng = np.random.default_rng([world, seed])
    scene = generate(kind, world).scene.with_robot(load_robot("jackal").model)
    params = SimParams(
        localization="amcl", lidar_noise_m=0.01, seed=seed, command_timeout_s=0.0,
        max_yaw_rate_radps=2.0, max_accel_mps2=5.0, max_yaw_accel_radps2=10.0,
    )  # fmt: skip
    simulator = Simulator(scene, params, start=generate(kind, world).start)
    cells, spec = rasterized(simulator)
    simulator.reset(start=free_pose(cells, spec, rng), seed=seed)
    odom_T_start = simulator.wheel_odometry().pose
    localizer = MapLocalizer(AmclParams(seed=seed), cells, spec)
    mount = simulator.lidars[0].mount.body_T_sensor.to_pose2()
    wanderer, right_since, spent_s, driven_m = Wanderer(), math.inf, 0.0, 0.0
    state, error_m = LocalizationState.LOCALIZING, math.inf
    for number in range(1, round(seconds * 1e9) // SCAN_NS + 1):
        simulator.advance_to(number * SCAN_NS)
        scan = simulator.scan()
        angles = scan.angle_min + scan.angle_increment * np.arange(len(scan.ranges))
        hit = np.isfinite(scan.ranges) & (scan.ranges < scan.range_max)
        ends = scan.ranges[hit, None] * np.column_stack(
            [np.cos(angles[hit]), np.sin(angles[hit])]
        )
        # The stack starts anywhere: odometry begins at zero.
        odom = odom_T_start.inverse() @ simulator.wheel_odometry().pose
        began = time.process_time()
        found = localizer.step(ScanView(mount.apply(ends), odom, number * SCAN_NS))
        spent_s += time.process_time() - began
        now_ns = number * SCAN_NS
        simulator.command(
            *wanderer.command(angles[hit], scan.ranges[hit], odom.yaw, now_ns)
        )
        driven_m += abs(simulator.motion().linear[0]) * SCAN_NS / 1e9
        state, true = found.state, simulator.pose().to_pose2()
        is_right = False
        if state is LocalizationState.LOCALIZED and found.map_T_odom is not None:
            pose = found.map_T_odom @ odom
            error_m = pose.distance_to(true)
            off = abs(angle_difference(pose.yaw, true.yaw))
            is_right = error_m <= RIGHT_M and off <= RIGHT_RAD
        since = min(right_since, number * SCAN_NS / 1e9)
        right_since = since if is_right else math.inf
    right = math.isfinite(right_since)
    return Outcome(
        f"{kind}:{world}/{seed}",
        right,
        str(state),
        error_m,
        right_since,
        driven_m,
        spent_s / seconds,
    )


def free_pose(
    cells: NDArray[np.int8], spec: GridSpec, rng: np.random.Generator
) -> Pose2:
    """Return a random pose with 0.5 m of free space around, inside the walls."""
    reach = round(0.5 / spec.resolution)
    inner = np.argwhere(cells == 100)
    low, high = inner.min(axis=0) + 2 * reach, inner.max(axis=0) - 2 * reach
    while True:
        row, column = rng.integers(low, high)
        around = cells[
            row - reach : row + reach + 1, column - reach : column + reach + 1
        ]
        if not around.any():
            x, y = spec.center_of(int(row), int(column))
            return Pose2(x, y, rng.uniform(-math.pi, math.pi))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--starts", type=int, default=100)
    parser.add_argument("--seconds", type=float, default=30.0)
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--worlds", type=int, default=10, help="of each kind")
    parser.add_argument("--first-world", type=int, default=0)
    given = parser.parse_args()
    outcomes = []
    for index in range(given.first, given.first + given.starts):
        kind = WORLDS[index % len(WORLDS)]
        world = given.first_world + index // 2 % given.worlds
        outcome = run(kind, world, index, given.seconds)
        outcomes.append(outcome)
        print(outcome, flush=True)
    times = [each.since_s for each in outcomes if each.right]
    summary = {
        "starts": len(outcomes),
        "right": sum(each.right for each in outcomes) / len(outcomes),
        "median_s": float(np.median(times)) if times else None,
        "error_m": float(
            np.median([o.error_m for o in outcomes if o.right] or [math.nan])
        ),
        "driven_m": float(np.median([each.driven_m for each in outcomes])),
        "cpu_share": float(np.mean([each.cpu_share for each in outcomes])),
    }
    print(json.dumps(summary))


if __name__ == "__main__":
    main()
