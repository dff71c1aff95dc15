"""Accuracy of SLAM in generated buildings, with several scanners and odometries.

  python benchmarks/bench_slam_buildings.py [--seeds 0,1] [NAME …]

Prints the error of the trajectory after alignment, unmatched scans, and the
processor time as a share of the drive. Exits with 1 if an error exceeds 0.1 m or a
share 1/20.
"""

import argparse
import math
import sys
import time
from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from bench_slam import absolute_errors
from numba import njit

from navette.geometry import Pose2, angle_difference
from navette.navigation.grids import PlanarScan
from navette.navigation.slam import Slam, SlamParams

ERROR_M, SHARE = 0.10, 1 / 20
SPEED_MPS, TURN_RADPS = 0.6, 1.0

Segments = np.ndarray
"""(N, 4) x1, y1, x2, y2, m."""
Points = list[tuple[float, float]]


class Scanner(NamedTuple):
    """A planar scanner."""

    beams: int = 720
    fov_deg: float = 360.0
    range_m: float = 30.0
    rate_hz: float = 10.0
    noise_m: float = 0.01


class Drift(NamedTuple):
    """Error of the odometry.

    Attributes:
        share: standard deviation of lengths and turns, constant and per scan.
        yaw_per_m: likewise of the yaw, rad, per distance.
        jumps: number of jumps of up to 1 m and 30° over the drive.
    """

    share: float = 0.02
    yaw_per_m: float = 0.005
    jumps: int = 0


class Building(NamedTuple):
    """Walls, and a drive through them."""

    walls: Segments
    tour: Points


class Case(NamedTuple):
    """A building with a scanner and an odometry."""

    building: Callable[[np.random.Generator], Building]
    scanner: Scanner = Scanner()
    drift: Drift = Drift()


def box(x: float, y: float, width: float, depth: float) -> list[tuple[float, ...]]:
    """Return the walls of a box with its lower left corner at (x, y)."""
    a, b = x + width, y + depth
    return [(x, y, a, y), (a, y, a, b), (a, b, x, b), (x, b, x, y)]


def row_of_rooms(
    x: float, y: float, count: int, depth: float, furniture: list[np.ndarray]
) -> list[tuple[float, ...]]:
    """Return rooms of 5 m along a corridor below them; doors of 1 m at their middles.

    ``furniture`` (count × (K, 4)) are boxes relative to the corner of each room.
    """
    side = math.copysign(1.0, depth)
    walls = [(x, y + depth, x + 5.0 * count, y + depth)]
    for k in range(count):
        left = x + 5.0 * k
        walls += [
            (left, y, left, y + depth),
            (left, y, left + 2.0, y),
            (left + 3.0, y, left + 5.0, y),
            (left + 2.0, y, left + 2.0, y + 0.15 * side),
            (left + 3.0, y, left + 3.0, y + 0.15 * side),
        ]
        for bx, by, wide, deep in furniture[k]:
            walls += box(left + bx, y + side * by, wide, side * deep)
    return [*walls, (x + 5.0 * count, y, x + 5.0 * count, y + depth)]


def furnished(rng: np.random.Generator, count: int, depth: float) -> list[np.ndarray]:
    """Return boxes along the side walls of ``count`` rooms, four each."""
    rooms = []
    for _ in range(count):
        size = rng.uniform(0.3, 1.2, (4, 2))
        x = np.array([0.1, 0.1, 4.9 - size[2, 0], 4.9 - size[3, 0]])
        y = rng.uniform(0.3, abs(depth) - 1.5, 4)
        rooms.append(np.column_stack([x, y, size]))
    return rooms


def ring(rng: np.random.Generator, *, alike: bool, visits: bool) -> Building:
    """Corridors of 100 m and 30 m around a core, with rooms along both long sides."""
    rooms = furnished(rng, 40, 5.0)
    if alike:
        rooms = [rooms[0]] * 40
    walls = row_of_rooms(0.0, 0.0, 20, -5.0, rooms[:20])
    walls += row_of_rooms(0.0, 30.0, 20, 5.0, rooms[20:])
    walls += [(0.0, 0.0, 0.0, 30.0), (100.0, 0.0, 100.0, 30.0)]
    walls += box(2.0, 2.0, 96.0, 26.0)
    if not alike:  # cupboards along the core
        for at in rng.uniform(3.0, 96.0, 12):
            walls += box(at, 2.0, rng.uniform(0.5, 1.5), -0.35)
            walls += box(at, 28.0, rng.uniform(0.5, 1.5), 0.35)

    def side(y: float, inside: float, order: list[int]) -> Points:
        tour: Points = []
        for k in order:
            x = 5.0 * k + 2.5
            tour += [(x, y), (x, inside), (x, y)]
        return tour

    chosen = list(range(1, 20, 3)) if visits else []
    tour = [
        (1.0, 1.0),
        *side(1.0, -2.5, chosen),
        (99.0, 1.0),
        (99.0, 29.0),
        *side(29.0, 32.5, chosen[::-1]),
        (1.0, 29.0),
        (1.0, 1.0),
        (40.0, 1.0),
    ]
    return Building(np.array(walls), tour)


def corridor(rng: np.random.Generator) -> Building:
    """A dead end of 100 m with doors and few cupboards: out and back."""
    walls = row_of_rooms(0.0, 0.0, 20, -5.0, furnished(rng, 20, 5.0))
    walls += [(0.0, 2.0, 100.0, 2.0), (0.0, 0.0, 0.0, 2.0), (100.0, 0.0, 100.0, 2.0)]
    for at in np.linspace(4.0, 94.0, 9) + rng.uniform(-3.0, 3.0, 9):
        walls += box(at, 2.0, rng.uniform(0.4, 1.5), -0.4)
    return Building(np.array(walls), [(1.0, 1.0), (99.0, 1.0), (1.0, 1.0)])


def hall(rng: np.random.Generator) -> Building:
    """A hall of 80 m × 60 m with columns and rows of shelves."""
    walls = box(0.0, 0.0, 80.0, 60.0)
    for x in range(10, 80, 10):
        for y in range(10, 60, 10):
            walls += box(x - 0.25, y - 0.25, 0.5, 0.5)
    for y in (15.0, 25.0, 35.0, 45.0):
        at = 12.0
        while at < 66.0:
            long = rng.uniform(2.0, 8.0)
            walls += box(at, y - 0.5, long, 1.0)
            at += long + rng.uniform(1.0, 5.0)
    tour = [
        (5.0, 5.0),
        (75.0, 5.0),
        (75.0, 20.0),
        (5.0, 20.0),
        (5.0, 30.0),
        (75.0, 30.0),
        (75.0, 40.0),
        (5.0, 40.0),
        (5.0, 55.0),
        (75.0, 55.0),
        (75.0, 5.0),
        (40.0, 5.0),
    ]
    return Building(np.array(walls), tour)


def offices(rng: np.random.Generator) -> Building:
    """Blocks of rooms, 12 m deep, between corridors of 50 m, with four loops."""
    walls = box(0.0, 0.0, 54.0, 44.0)
    for block in range(3):
        y = 2.0 + 14.0 * block
        for left in (2.0, 28.0):
            below, above = furnished(rng, 4, 6.0), furnished(rng, 4, 6.0)
            walls += row_of_rooms(left + 2.0, y, 4, 6.0, below)
            walls += row_of_rooms(left + 2.0, y + 12.0, 4, -6.0, above)
    for at in rng.uniform(3.0, 50.0, 14):
        walls += box(at, 0.0, rng.uniform(0.4, 1.2), 0.35)
    x = (1.0, 26.0, 52.0)
    y = (1.0, 15.0, 29.0, 43.0)
    tour = [
        (x[0], y[0]),
        (x[2], y[0]),
        (x[2], y[3]),
        (x[0], y[3]),
        (x[0], y[1]),
        (x[1], y[1]),
        (x[1], y[0]),
        (x[1], y[3]),
        (x[2], y[3]),
        (x[2], y[2]),
        (x[0], y[2]),
        (x[0], y[0]),
        (16.5, y[0]),
        (16.5, 5.0),
        (16.5, y[0]),
        (x[1], y[0]),
        (x[1], y[1]),
    ]
    return Building(np.array(walls), tour)


def twins(rng: np.random.Generator) -> Building:
    """A corridor of 60 m with twelve rooms that are furnished alike, each visited."""
    walls = row_of_rooms(0.0, 0.0, 12, -5.0, [furnished(rng, 1, 5.0)[0]] * 12)
    walls += [(0.0, 2.0, 60.0, 2.0), (0.0, 0.0, 0.0, 2.0), (60.0, 0.0, 60.0, 2.0)]
    tour: Points = [(1.0, 1.0)]
    for k in [*range(12), *range(10, -1, -2)]:
        x = 5.0 * k + 2.5
        tour += [(x, 1.0), (x, -2.5), (x, 1.0)]
    return Building(np.array(walls), [*tour, (1.0, 1.0)])


FRONT = Scanner(beams=361, fov_deg=180.0)
NEAR = Scanner(beams=360, range_m=10.0)
NEAR_FRONT = Scanner(beams=181, fov_deg=180.0, range_m=10.0)

CASES: dict[str, Case] = {
    "ring": Case(lambda rng: ring(rng, alike=False, visits=False)),
    "ring-front": Case(lambda rng: ring(rng, alike=False, visits=False), FRONT),
    "ring-10m": Case(lambda rng: ring(rng, alike=False, visits=False), NEAR),
    "ring-alike": Case(lambda rng: ring(rng, alike=True, visits=True)),
    "ring-alike-10m": Case(
        lambda rng: ring(rng, alike=True, visits=True), NEAR, Drift(0.05, 0.01)
    ),
    "ring-rooms-5Hz": Case(
        lambda rng: ring(rng, alike=False, visits=True),
        Scanner(beams=360, range_m=10.0, rate_hz=5.0),
        Drift(0.05, 0.01),
    ),
    "corridor": Case(corridor),
    "corridor-front": Case(corridor, FRONT),
    "corridor-front-10m": Case(corridor, NEAR_FRONT),
    "hall-80m": Case(hall, Scanner(range_m=80.0)),
    "hall-10m": Case(hall, NEAR),
    "hall-front": Case(hall, FRONT, Drift(0.05, 0.01)),
    "offices": Case(offices),
    "offices-jumps": Case(offices, drift=Drift(0.02, 0.005, jumps=8)),
    "offices-40Hz": Case(offices, Scanner(beams=1081, fov_deg=270.0, rate_hz=40.0)),
    "offices-5Hz-10m": Case(
        offices, Scanner(360, 360.0, 10.0, 5.0, 0.02), Drift(0.05, 0.01)
    ),
    "offices-front-10m": Case(offices, NEAR_FRONT, Drift(0.03, 0.01)),
    "twins": Case(twins),
    "twins-10m": Case(twins, NEAR, Drift(0.05, 0.01)),
    "twins-front": Case(twins, FRONT, Drift(0.03, 0.01, jumps=4)),
}


@njit
def ray_cast(walls: Segments, x: float, y: float, angles: np.ndarray, far: float):
    ranges = np.full(angles.size, np.inf)
    near = np.empty(walls.shape[0], np.int64)
    count = 0
    for k in range(walls.shape[0]):
        x1, y1, x2, y2 = walls[k]
        dx, dy = x2 - x1, y2 - y1
        share = ((x - x1) * dx + (y - y1) * dy) / max(1e-12, dx * dx + dy * dy)
        share = min(1.0, max(0.0, share))
        if math.hypot(x1 + share * dx - x, y1 + share * dy - y) < far:
            near[count] = k
            count += 1
    for i in range(angles.size):
        c, s = math.cos(angles[i]), math.sin(angles[i])
        best = far
        for n in range(count):
            x1, y1, x2, y2 = walls[near[n]]
            dx, dy = x2 - x1, y2 - y1
            cross = c * dy - s * dx
            if abs(cross) < 1e-12:
                continue
            t = ((x1 - x) * dy - (y1 - y) * dx) / cross
            u = ((x1 - x) * s - (y1 - y) * c) / cross
            if 0.0 <= u <= 1.0 and 0.0 < t < best:
                best = t
        if best < far:
            ranges[i] = best
    return ranges


def poses_along(tour: Points, rate_hz: float) -> Iterator[Pose2]:
    """Yield poses of a drive along a tour; the robot turns in place at its corners."""
    step, turn_step = SPEED_MPS / rate_hz, TURN_RADPS / rate_hz
    (x, y), after = tour[0], tour[1]
    yaw = math.atan2(after[1] - y, after[0] - x)
    yield Pose2(x, y, yaw)
    for (x1, y1), (x2, y2) in pairwise(tour):
        heading = math.atan2(y2 - y1, x2 - x1)
        while abs(turn := angle_difference(heading, yaw)) > 1e-6:
            yaw += max(-turn_step, min(turn_step, turn))
            yield Pose2(x1, y1, yaw)
        count = max(1, round(math.hypot(x2 - x1, y2 - y1) / step))
        for k in range(1, count + 1):
            share = k / count
            # No drive is straight.
            bend = 0.05 * math.sin(math.pi * share)
            yield Pose2(
                x1 + share * (x2 - x1) - bend * math.sin(heading),
                y1 + share * (y2 - y1) + bend * math.cos(heading),
                heading,
            )


def run(case: Case, seed: int) -> tuple[Slam, list[Pose2], list[Pose2], float]:
    """Return the SLAM after a drive, the odometry, the true poses and its time (s)."""
    rng = np.random.default_rng([seed, 14])
    building, scanner, drift = case.building(rng), case.scanner, case.drift
    truths = list(poses_along(building.tour, scanner.rate_hz))
    fov = math.radians(scanner.fov_deg)
    increment = fov / (scanner.beams if scanner.fov_deg == 360.0 else scanner.beams - 1)
    angles = -fov / 2 + increment * np.arange(scanner.beams)
    scale, bias = 1 + drift.share * rng.normal(), drift.yaw_per_m * rng.normal()
    jumps = set(rng.integers(0, len(truths), drift.jumps).tolist())
    # Noise per distance, whatever the rate of the scans.
    grain = math.sqrt(scanner.rate_hz)
    slam, odometry, spent = Slam(SlamParams()), [Pose2(0.0, 0.0, 0.0)], 0.0
    for k, pose in enumerate(truths):
        if k:
            x, y, turn = truths[k - 1].inverse() @ pose
            length = scale * (1 + grain * drift.share * rng.normal())
            turn *= 1 + grain * drift.share * rng.normal()
            noise = bias + grain * drift.yaw_per_m * rng.normal()
            step = Pose2(x * length, y * length, turn + math.hypot(x, y) * noise)
            odometry.append(odometry[-1] @ step)
        if k in jumps:
            jump = rng.uniform(-1.0, 1.0, 3) * (1.0, 1.0, math.radians(30.0))
            odometry[-1] = odometry[-1] @ Pose2(*jump)
        ranges = ray_cast(
            building.walls, pose.x, pose.y, angles + pose.yaw, scanner.range_m
        )
        ranges += scanner.noise_m * rng.normal(size=scanner.beams)
        scan = PlanarScan(
            ranges.astype(np.float32), -fov / 2, increment, 0.05, scanner.range_m
        )
        began = time.process_time()
        slam.add(round((k + 1) * 1e9 / scanner.rate_hz), scan, odometry[-1])
        spent += time.process_time() - began
    began = time.process_time()
    slam.refine()
    return slam, odometry, truths, spent + time.process_time() - began


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", default="0")
    parser.add_argument("names", nargs="*")
    given = parser.parse_args()
    failed = False
    for name in given.names or CASES:
        for seed in map(int, given.seeds.split(",")):
            slam, odometry, truths, cpu_s = run(CASES[name], seed)
            made = [pose for _, pose in slam.trajectory()]
            errors, raw = (
                absolute_errors(made, truths),
                absolute_errors(odometry, truths),
            )
            rmse = math.sqrt((errors**2).mean())
            share = cpu_s / (len(truths) / CASES[name].scanner.rate_hz)
            is_good = rmse <= ERROR_M and share <= SHARE
            failed |= not is_good
            print(
                f"{name:20} {seed} {len(truths):6} scans  ATE {rmse:.3f} m, worst "
                f"{errors.max():.3f} m (odometry {raw.max():.1f} m)  "
                f"{slam.loop_closures} closures, {slam.unmatched} unmatched, "
                f"{len(slam.graph)} keys, {cpu_s:.1f} s, 1/{1 / share:.0f}"
                f"{'' if is_good else '  FAILED'}",
                flush=True,
            )
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
