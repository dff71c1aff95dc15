"""Moving obstacles from scans of scenes whose motion is known."""

import math

import numpy as np
import pytest

from navette.geometry import Pose2
from navette.navigation.grids import PlanarScan
from navette.navigation.tracking import (
    MovingObstacles,
    TrackedObstacle,
    TrackingParams,
)
from navette.navigation.tracking.clusters import fit_disc, segment
from navette.sim import Scene, SimParams, Simulator, World, load_robot

PERIOD_NS = 50_000_000


def _simulator(world: World, noise_m: float = -1.0, dropout: float = 0.0) -> Simulator:
    scene: Scene = world.scene().with_robot(load_robot("jackal").model)
    params = SimParams(
        lidar_noise_m=noise_m, lidar_dropout=dropout, command_timeout_s=0.0
    )
    return Simulator(scene, params, start=Pose2(0.0, 0.0, 0.0))


def _track(
    simulator: Simulator, seconds: float, command: tuple[float, float] = (0.0, 0.0)
) -> list[list[TrackedObstacle]]:
    """Return what moves at each scan, with the robot on a command."""
    obstacles = MovingObstacles(TrackingParams())
    found = []
    for _ in range(round(seconds * 1e9 / PERIOD_NS)):
        simulator.command(*command)
        simulator.advance_to(simulator.now_ns + PERIOD_NS)
        scan = simulator.scan()
        sensor = simulator.pose().to_pose2() @ Pose2(0.055, 0.0, 0.0)
        planar = PlanarScan(
            scan.ranges,
            scan.angle_min,
            scan.angle_increment,
            scan.range_min,
            scan.range_max,
        )
        found.append(obstacles.step(planar, sensor, simulator.now_ns))
    return found


@pytest.mark.parametrize(("vx", "vy"), [(0.0, 1.0), (-0.8, 0.5), (0.6, 0.0), (0, 0.3)])
def test_position_and_velocity_of_a_cylinder(vx: float, vy: float) -> None:
    x, y = 4.0 - vx, -1.5 * vy
    world = World().add_walls((16, 16))
    world.add_actor([(0, x, y), (4, x + 4 * vx, y + 4 * vy)], 0.3, loop=False)
    found = _track(_simulator(world), 3.0)
    assert any(found[i] for i in range(16))  # within 0.8 s
    (last,) = found[-1]
    assert last[1:5] == pytest.approx((x + 3 * vx, y + 3 * vy, vx, vy), abs=0.08)
    assert last.radius_m == pytest.approx(0.3, abs=0.05)
    numbers = {each.number for step in found for each in step}
    assert len(numbers) == 1  # one track


@pytest.mark.parametrize("gap_m", [-0.4, -0.2, 0.05])
def test_cylinders_that_pass_each_other_keep_their_tracks(gap_m: float) -> None:
    """The two have one run of returns while they pass, or overlap."""
    apart = (0.6 + gap_m) / 2
    world = World().add_walls((16, 16))
    world.add_actor([(0, 4 - apart, -2.0), (4, 4 - apart, 2.0)], 0.3, loop=False)
    world.add_actor([(0, 4 + apart, 2.5), (4, 4 + apart, -1.5)], 0.3, loop=False)
    found = _track(_simulator(world), 3.6)
    for i in range(30, 72):
        seconds = (i + 1) * 0.05
        truth = ((4 - apart, seconds - 2.0, 1.0), (4 + apart, 2.5 - seconds, -1.0))
        assert len(found[i]) == 2, f"at {seconds:.2f} s"
        for x, y, vy in truth:
            near = min(found[i], key=lambda t, x=x, y=y: math.hypot(t.x - x, t.y - y))
            assert math.hypot(near.x - x, near.y - y) < 0.15, f"at {seconds:.2f} s"
            assert near.vy == pytest.approx(vy, abs=0.35), f"at {seconds:.2f} s"


def test_nothing_moves_in_a_still_world_with_noise_seen_from_a_moving_robot() -> None:
    world = (
        World().add_walls((16, 16)).add_box((3, 2), (0.5, 0.5)).add_box((4, -1), (1, 1))
    )
    rng = np.random.default_rng(3)
    for x, y in rng.uniform((1, 1.5), (7, 7), (30, 2)).tolist():
        world.add_cylinder((x, y), 0.075)
    found = _track(_simulator(world, 0.02, 0.05), 4.0, (0.6, 0.3))
    assert not any(found)


def test_a_walker_in_front_of_a_wall_is_not_the_wall() -> None:
    world = World().add_box((4, 0), (0.2, 10))
    world.add_actor([(0, 3.4, -2), (4, 3.4, 2)], 0.25)
    found = _track(_simulator(world), 3.0)
    (last,) = found[-1]
    assert last[1:5] == pytest.approx((3.4, 1.0, 0.0, 1.0), abs=0.2)


def test_an_obstacle_that_passes_behind_a_post_is_still_tracked() -> None:
    world = World().add_walls((16, 16)).add_cylinder((2, 0), 0.3)
    world.add_actor([(0, 4, -2), (4, 4, 2)], 0.25, loop=False)
    found = _track(_simulator(world), 3.6)
    hidden = found[40]  # at 2 s
    (each,) = [each for each in hidden if abs(each.x - 4) < 0.4]
    assert each.vy == pytest.approx(1.0, abs=0.2)
    after = found[-1][0]
    assert (after.x, after.y) == pytest.approx((4, 1.6), abs=0.15)


def test_an_obstacle_that_stops_is_no_longer_moving_and_one_that_leaves_is_gone() -> (
    None
):
    world = World().add_walls((16, 16))
    world.add_actor([(0, 4, -1), (1, 4, 0), (9, 4, 0.01)], 0.3, loop=False)
    found = _track(_simulator(world), 3.5)
    assert found[18]
    assert not found[-1]


def test_a_jump_back_in_time_forgets_everything() -> None:
    obstacles = MovingObstacles(TrackingParams())
    near = PlanarScan(np.full(90, 2.0, np.float32), -0.5, 0.011, 0.1, 10.0)
    for stamp_ns in (0, 300_000_000, 600_000_000, 0):
        assert obstacles.step(near, Pose2(0, 0, 0), stamp_ns) == []


def test_invalid_ranges_and_empty_scans_contain_nothing() -> None:
    obstacles = MovingObstacles(TrackingParams())
    for stamp_ns, value in enumerate((np.nan, np.inf, -np.inf, 0.0)):
        ranges = np.full(50, value, np.float32)
        scan = PlanarScan(ranges, -0.5, 0.02, 0.1, 10.0)
        assert obstacles.step(scan, Pose2(0, 0, 0), stamp_ns * PERIOD_NS) == []
    empty = PlanarScan(np.empty(0, np.float32), 0.0, 0.1, 0.1, 10.0)
    assert obstacles.step(empty, Pose2(0, 0, 0), 10**9) == []


def test_circle_is_found_from_its_near_side() -> None:
    angles = np.linspace(2.0, 4.2, 20)
    points = np.column_stack([3 + 0.4 * np.cos(angles), 1 + 0.4 * np.sin(angles)])
    disc = fit_disc(points, (0.0, 1.0), 1.0)
    assert disc[:3] == pytest.approx((3.0, 1.0, 0.4), abs=1e-6)
    assert disc[3]


def test_flat_face_becomes_a_disc_of_its_width_behind_it() -> None:
    face = np.column_stack([np.full(9, 2.0), np.linspace(-0.4, 0.4, 9)])
    x, y, radius, is_round = fit_disc(face, (0.0, 0.0), 0.8)
    assert not is_round
    assert radius == pytest.approx(0.4)
    assert 2.0 < x <= 2.4
    assert y == pytest.approx(0.0)


def test_runs_end_at_gaps_but_not_at_one_lost_beam() -> None:
    angles = np.linspace(-0.5, 0.5, 41)
    away = np.where(angles < 0.1, 2.0, 3.0)
    points = np.column_stack([away * np.cos(angles), away * np.sin(angles)])
    valid = np.ones(41, np.bool_)
    valid[5] = False
    runs = segment(points, valid, away, 0.25)
    assert runs.tolist() == [[0, 24], [24, 41]]
    assert math.isclose(away[23], 2.0)
