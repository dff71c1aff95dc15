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
from navette.navigation.tracking.clusters import (
    Cluster,
    convex_parts,
    fit_disc,
    is_whole,
    segment,
)
from navette.navigation.tracking.tracks import Track
from navette.sim import Scene, SimParams, Simulator, World, load_robot

PERIOD_NS = 50_000_000


def _simulator(world: World, noise_m: float = -1.0, dropout: float = 0.0) -> Simulator:
    scene: Scene = world.scene().with_robot(load_robot("jackal").model)
    params = SimParams(
        lidar_noise_m=noise_m, lidar_dropout=dropout, command_timeout_s=0.0
    )
    return Simulator(scene, params, start=Pose2(0.0, 0.0, 0.0))


def _track(
    simulator: Simulator,
    seconds: float,
    command: tuple[float, float] = (0.0, 0.0),
    range_max: float = 30.0,
) -> list[list[TrackedObstacle]]:
    """Return what moves at each scan, with the robot on a command.

    The sensor measures no farther than ``range_max``.
    """
    obstacles = MovingObstacles(TrackingParams())
    found = []
    for _ in range(round(seconds * 1e9 / PERIOD_NS)):
        simulator.command(*command)
        simulator.advance_to(simulator.now_ns + PERIOD_NS)
        scan = simulator.scan()
        sensor = simulator.pose().to_pose2() @ Pose2(0.055, 0.0, 0.0)
        planar = PlanarScan(
            np.where(scan.ranges < range_max, scan.ranges, np.float32(np.inf)),
            scan.angle_min,
            scan.angle_increment,
            scan.range_min,
            range_max,
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


def test_cylinders_that_move_side_by_side_are_two_from_the_beginning() -> None:
    """Their returns have no gap at any time, and are wider than one may be."""
    world = World().add_walls((16, 16))
    for x, y in ((4.0, -2.0), (4.0, -2.9)):
        world.add_actor([(0, x, y), (4, x, y + 4)], 0.5, loop=False)
    last = _track(_simulator(world), 2.5)[-1]
    assert len(last) == 2
    for each, y in zip(sorted(last, key=lambda t: t.y), (-0.4, 0.5), strict=True):
        assert (each.x, each.y) == pytest.approx((4.0, y), abs=0.1)
        assert each.vy == pytest.approx(1.0, abs=0.2)
        assert each.radius_m == pytest.approx(0.5, abs=0.1)


def test_radius_is_learned_when_the_whole_obstacle_is_seen() -> None:
    """At first a part of the circle is seen: its near side stays where it is."""
    params = TrackingParams()
    track = Track.begin(1, Cluster(3.2, 0, 0.2, False, False, 9), 0, params)
    track.predict(PERIOD_NS, params.acceleration_mps2)
    track.update(Cluster(3.5, 0, 0.5, True, True, 9), (0.0, 0.0), params)
    assert track.radius_m == pytest.approx(0.5)
    assert track.x == pytest.approx(3.5)
    assert math.hypot(track.vx, track.vy) < 1e-9
    track.predict(2 * PERIOD_NS, params.acceleration_mps2)
    track.update(Cluster(3.3, 0, 0.3, True, False, 9), (0.0, 0.0), params)
    assert track.radius_m == pytest.approx(0.5)  # hidden again


def test_velocity_holds_where_the_field_of_view_cuts_the_obstacle() -> None:
    """The robot turns away; fewer and fewer beams hit the cylinder, then none."""
    world = World().add_walls((16, 16))
    world.add_actor([(0, 2, -1.5), (6, 2, 1.5)], 0.5, loop=False)
    found = _track(_simulator(world), 3.2, (0.0, 0.9))
    for i in range(24, 64):
        (each,) = found[i]
        seconds = (i + 1) * 0.05
        assert (each.vx, each.vy) == pytest.approx((0.0, 0.5), abs=0.15), seconds
        assert each.y == pytest.approx(0.5 * seconds - 1.5, abs=0.1), seconds


def test_nothing_moves_in_a_still_world_with_noise_seen_from_a_moving_robot() -> None:
    world = (
        World().add_walls((16, 16)).add_box((3, 2), (0.5, 0.5)).add_box((4, -1), (1, 1))
    )
    rng = np.random.default_rng(3)
    for x, y in rng.uniform((1, 1.5), (7, 7), (30, 2)).tolist():
        world.add_cylinder((x, y), 0.075)
    found = _track(_simulator(world, 0.02, 0.05), 4.0, (0.6, 0.3))
    assert not any(found)


def test_nothing_moves_where_a_still_world_comes_into_the_range_of_the_sensor() -> None:
    """A beam without a return passed nothing beyond its range."""
    world = World().add_walls((12, 12)).add_box((4, 2), (0.5, 0.5))
    for x in (2.0, 3.0, 4.5):
        world.add_cylinder((x, -2.0), 0.2)
    found = _track(_simulator(world), 5.0, (0.8, 0.1), range_max=3.5)
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


def test_a_centre_that_moves_back_and_forth_stands() -> None:
    # That of a wall of which a robot that turns sees more, then less.
    params, sensor = TrackingParams(), (0.0, 0.0)
    centres = [3.0 + 0.1 * i for i in range(6)]
    centres += [3.5 + 0.1 * math.sin(2 * math.pi * i / 10) for i in range(60)]
    track, moving = None, []
    for i, x in enumerate(centres):
        cluster = Cluster(x, 2.0, 0.5, True, False, 5 if i < 6 else 0)
        if track is None:
            track = Track.begin(1, cluster, 0, params)
            continue
        track.predict(i * 100_000_000, params.acceleration_mps2)
        track.update(cluster, sensor, params)
        moving.append(track.is_moving)
    assert any(moving[:6])
    assert not any(moving[25:])


def test_a_slow_track_without_measurements_stops_counting() -> None:
    params = TrackingParams()
    track = Track.begin(1, Cluster(3.0, 0.0, 0.3, True, False, 5), 0, params)
    for i in range(1, 5):
        track.predict(i * 100_000_000, params.acceleration_mps2)
        x = 3.0 + 0.05 * i
        track.update(Cluster(x, 0.0, 0.3, True, False, 5), (0.0, 0.0), params)
    assert track.is_moving
    track.vx = 0.05
    for i in range(5, 16):
        track.predict(i * 100_000_000, params.acceleration_mps2)
        track.miss(params)
    assert not track.is_moving


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


def test_run_of_two_discs_is_divided_where_they_meet_and_one_disc_is_not() -> None:
    def near_side(x: float, y: float) -> np.ndarray:
        angles = np.linspace(1.5 * math.pi, 0.5 * math.pi, 40)
        return np.column_stack([x + 0.5 * np.cos(angles), y + 0.5 * np.sin(angles)])

    low, high = near_side(3.0, -0.4), near_side(3.2, 0.4)
    low, high = low[low[:, 1] < 0.0], high[high[:, 1] > 0.0]
    both = np.ascontiguousarray(np.concatenate([low, high]))
    for points, border in ((both, len(low)), (both[::-1].copy(), len(high))):
        first, second = convex_parts(points, (0.0, 0.0), 0.075)
        assert abs(len(first) - border) <= 1
        assert [*first, *second] == list(range(len(points)))
    (alone,) = convex_parts(np.ascontiguousarray(near_side(3, 0)), (0.0, 0.0), 0.075)
    assert len(alone) == 40


@pytest.mark.parametrize(
    ("first", "stop", "turn", "whole"),
    [
        (2, 4, 1.0, True),  # both neighbours are farther
        (4, 6, 1.0, False),  # the one before is nearer
        (0, 2, 1.0, False),  # the field of view ends
        (8, 10, 1.0, False),
        (8, 10, 2 * math.pi, False),  # its neighbour is the first beam: nearer
        (6, 8, 1.0, False),  # a lost beam beside it
    ],
)
def test_whole_is_what_beams_pass_on_both_sides(
    first: int, stop: int, turn: float, whole: bool
) -> None:
    ranges = np.array([3, 3, 2, 2, 5, 5, 4, 4, math.nan, 6], np.float32)
    assert is_whole(ranges, first, stop, turn) is whole
