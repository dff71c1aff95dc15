"""AMCL on a map of two rooms, with exact scans by ray casting."""

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from navette.geometry import Pose2, angle_difference
from navette.navigation.grids import GridSpec
from navette.navigation.localization.amcl import (
    AmclParams,
    LikelihoodField,
    ParticleFilter,
    global_search,
)
from navette.navigation.localization.amcl.confidence import (
    DoubtCause,
    LocalizationState,
)
from navette.navigation.localization.amcl.estimate import heaviest_cluster
from navette.navigation.localization.amcl.global_search import search_map
from navette.navigation.localization.amcl.localizer import (
    Located,
    MapLocalizer,
    ScanView,
    default_covariance,
    is_usable,
)
from navette.navigation.localization.amcl.motion_model import (
    move_differential,
    move_omni,
    noise_of_motion,
)
from navette.navigation.localization.amcl.resampling import (
    kld_limit,
    occupied_bins,
    resampled,
)

CELL_M = 0.05
SCAN_NS = 100_000_000


def two_rooms() -> tuple[NDArray[np.int8], GridSpec]:
    """10 m x 5 m with a wall and a door in the middle, and different furniture."""
    cells = np.zeros((100, 200), np.int8)
    cells[:2], cells[-2:], cells[:, :2], cells[:, -2:] = 100, 100, 100, 100
    cells[:40, 99:101] = cells[60:, 99:101] = 100
    cells[20:30, 20:50] = 100
    cells[70:90, 150:160] = 100
    cells[10:20, 170:180] = 100
    return cells, GridSpec(CELL_M, 200, 100, Pose2(-1.0, -2.0, 0.3))


CELLS, SPEC = two_rooms()


def cast(pose: Pose2, beams: int = 180) -> NDArray[np.float64]:
    """Return where beams from a pose end (N, 2), base frame."""
    angles = np.arange(beams) * (2 * math.pi / beams)
    along = np.arange(0.0, 12.0, CELL_M / 2)
    local = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    points = local[:, None] * along[:, None]
    on_map = pose.apply(points.reshape(-1, 2))
    uv = np.floor(SPEC.origin.inverse().apply(on_map) / CELL_M).astype(int)
    inside = ((uv >= 0) & (uv < (SPEC.width, SPEC.height))).all(axis=1)
    uv[~inside] = 0
    hit = (CELLS[uv[:, 1], uv[:, 0]] == 100).reshape(beams, -1)
    return points[np.arange(beams), hit.argmax(axis=1)]


def at(u: float, v: float, yaw: float) -> Pose2:
    """Return a pose by metres from the map's corner."""
    return SPEC.origin @ Pose2(u, v, yaw)


def field(sigma: float = 0.15) -> LikelihoodField:
    return LikelihoodField.of(CELLS, SPEC, sigma=sigma, random=0.1, reach_m=2.0)


def steps(
    localizer: MapLocalizer, poses: list[Pose2], odom: Pose2, first: int = 0
) -> Located:
    """Use the scans from poses; odometry runs in a frame of its own, ``odom``."""
    for number, pose in enumerate(poses, first):
        view = ScanView(cast(pose), odom.inverse() @ pose, number * SCAN_NS)
        located = localizer.step(view)
    return located


def line(u: float, v: float, yaw: float, count: int) -> list[Pose2]:
    start = at(u, v, yaw)
    return [start @ Pose2(0.12 * k, 0.0, 0.0) for k in range(count)]


def off(located: Located, pose: Pose2, odom: Pose2) -> float:
    assert located.map_T_odom is not None
    found = located.map_T_odom @ (odom.inverse() @ pose)
    assert abs(angle_difference(found.yaw, pose.yaw)) < 0.05
    return found.distance_to(pose)


def test_likelihoods_follow_the_distance() -> None:
    grid = field()
    pose = at(2.5, 3.5, 0.7)
    points = cast(pose)
    poses = np.array([pose, pose @ Pose2(0.1, 0, 0), pose @ Pose2(1.0, 0, 0)])
    exact, near, far = grid.scores(poses, points)
    assert exact > near > far
    assert exact > -0.1
    assert grid.share_within(np.array(pose), points, 0.1) == 1.0
    beyond = grid.scores(np.array([[99.0, 99.0, 0.0]]), points)
    assert beyond[0] == pytest.approx(math.log(0.1), abs=1e-6)


def test_refinement_climbs_to_the_pose() -> None:
    pose = at(2.5, 3.5, 0.7)
    start = np.array([pose @ Pose2(0.15, -0.1, 0.08)])
    (found,), _ = field().refined(start, cast(pose), 0.1, 0.05)
    assert found == pytest.approx(np.array(pose), abs=0.05)


def test_the_search_of_the_map_finds_the_pose_first() -> None:
    for pose in (at(2.0, 3.5, 2.0), at(7.0, 2.0, -1.0)):
        best = search_map(field(), cast(pose)).poses[0]
        assert pose.distance_to(Pose2(*best)) < 0.1
        assert abs(angle_difference(best[2], pose.yaw)) < 0.05
    assert len(search_map(field(), np.empty((0, 2))).poses) == 0


@pytest.mark.parametrize("blocks", [40_000, 5_000])
def test_the_search_of_a_large_map_scores_the_best_blocks_only(
    blocks: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The bounds are lower here, so that a small map is a large one."""
    monkeypatch.setattr(global_search, "_MOST_BLOCKS", blocks)
    monkeypatch.setattr(global_search, "_MOST_POSES", 8_000)
    monkeypatch.setattr(global_search, "_MOST_CELLS", 8_000 // 48)
    grid = field()
    is_free = grid.is_free()
    assert is_free.sum() > 100 * 8_000 // 48
    for pose in (at(2.0, 3.5, 2.0), at(7.0, 2.0, -1.0), at(8.1, 3.3, 0.4)):
        points = cast(pose)
        assert len(global_search._coarse_poses(grid, is_free, points)) <= 8_000
        best = search_map(grid, points).poses[0]
        assert pose.distance_to(Pose2(*best)) < 0.1
        assert abs(angle_difference(best[2], pose.yaw)) < 0.05


def test_motion_spreads_as_the_model_states() -> None:
    rng = np.random.default_rng(1)
    for move in (move_differential, move_omni):
        particles = np.zeros((4000, 3))
        move(particles, Pose2(-1.0, 0.0, 0.0), (0.0, 0.0, 0.04, 0.0, 0.01), rng)
        assert particles.mean(axis=0) == pytest.approx([-1.0, 0.0, 0.0], abs=0.01)
        assert particles[:, 0].std() == pytest.approx(0.2, rel=0.05)
        assert np.abs(particles[:, 2]).max() < 0.01 or move is move_differential
    sideways = np.zeros((1000, 3))
    move_omni(sideways, Pose2(0.0, 1.0, 0.0), (0.0, 0.0, 0.01, 0.0, 0.0), rng)
    assert sideways.mean(axis=0) == pytest.approx([0.0, 1.0, 0.0], abs=0.02)


def test_resampling_keeps_shares_and_adapts_the_number() -> None:
    rng = np.random.default_rng(2)
    particles = np.array([[0.0, 0, 0], [5.0, 0, 0]])
    drawn = resampled(particles, np.array([0.25, 0.75]), 1000, rng)
    assert (drawn[:, 0] == 5.0).mean() == pytest.approx(0.75, abs=0.01)
    assert occupied_bins(drawn) == 2
    # Fox 2003: chi-square quantile of k - 1 degrees of freedom over 2 epsilon.
    assert kld_limit(1, 0.05, 0.99) == 1
    assert kld_limit(11, 0.05, 0.99) == pytest.approx(23.2 / 0.1, rel=0.01)


@pytest.mark.parametrize("share_of_bins", [0.0, 0.5])
def test_the_heaviest_cluster_is_the_estimate(share_of_bins: float) -> None:
    """Also where it lies in eight bins, and the other one in one."""
    rng = np.random.default_rng(3)
    many = rng.normal((2.0, 1.0, math.pi), (0.1, 0.1, 0.05), (300, 3))
    few = rng.normal((8.25, 1.25, 0.17), (0.05, 0.05, 0.03), (100, 3))
    many[:, :2] += 0.5 * share_of_bins
    particles = np.concatenate([many, few])
    particles[:, 2] = (particles[:, 2] + math.pi) % (2 * math.pi) - math.pi
    found = heaviest_cluster(particles, np.full(400, 1 / 400))
    place = 2.0 + 0.5 * share_of_bins, 1.0 + 0.5 * share_of_bins
    assert (found.pose.x, found.pose.y) == pytest.approx(place, abs=0.03)
    assert abs(angle_difference(found.pose.yaw, math.pi)) < 0.02
    assert found.share == pytest.approx(0.75, abs=0.01)
    assert found.stddev_m == pytest.approx(0.1, rel=0.15)


def test_the_filter_narrows_an_inexact_pose() -> None:
    params = AmclParams(seed=1)
    particles = ParticleFilter(params, field(), np.random.default_rng(1))
    pose = at(2.0, 3.5, 0.3)
    particles.set_pose(pose @ Pose2(0.2, 0.1, 0.1), default_covariance(params))
    wide = particles.estimate().stddev_m
    for _ in range(6):
        particles.update(cast(pose, 60))
    found = particles.estimate()
    assert found.pose.distance_to(pose) < 0.06
    assert found.stddev_m < 0.4 * wide
    assert len(particles.particles) < params.max_particles


@pytest.mark.parametrize("seed", range(3))
def test_an_unknown_pose_is_found_while_driving(seed: int) -> None:
    localizer = MapLocalizer(AmclParams(seed=seed), CELLS, SPEC)
    odom = Pose2(3.0, -4.0, 1.0)
    poses = line(1.0, 3.5, 0.0, 12)
    located = steps(localizer, poses, odom)
    assert located.state is LocalizationState.LOCALIZED
    assert off(located, poses[-1], odom) < 0.06


def test_a_carried_robot_is_lost_and_found() -> None:
    localizer = MapLocalizer(AmclParams(), CELLS, SPEC)
    odom = Pose2(0.0, 0.0, 0.0)
    before = line(1.0, 3.5, 0.0, 10)
    localizer.set_pose(before[0], default_covariance(localizer.params))
    assert off(steps(localizer, before, odom), before[-1], odom) < 0.08
    # Carried to the other room; odometry did not notice.
    carried = line(6.5, 1.5, 1.2, 20)
    noticed = before[-1] @ carried[0].inverse()
    seen = set()
    for number, pose in enumerate(carried, 100):
        view = ScanView(cast(pose), noticed @ pose, number * SCAN_NS)
        located = localizer.step(view)
        seen.add(located.state)
    assert located.state is LocalizationState.LOCALIZED
    assert off(located, carried[-1], noticed.inverse()) < 0.08


def test_a_scan_that_fits_nowhere_means_lost() -> None:
    params = AmclParams(lost_time_s=0.5)
    localizer = MapLocalizer(params, CELLS, SPEC)
    pose = at(2.0, 3.5, 0.0)
    localizer.set_pose(pose, default_covariance(params))
    angles = np.linspace(0, 6.2, 120)
    crowd = 0.7 * np.column_stack([np.cos(angles), np.sin(angles)])
    for number in range(12):
        step = pose @ Pose2(0.05 * number, 0.0, 0.0)
        located = localizer.step(ScanView(crowd, step, number * SCAN_NS))
    assert located.state is LocalizationState.LOST
    assert located.map_T_odom is not None  # the last correction stays


def test_no_echo_changes_nothing() -> None:
    localizer = MapLocalizer(AmclParams(), CELLS, SPEC)
    nothing = ScanView(np.empty((0, 2)), Pose2(0, 0, 0), 0)
    assert localizer.step(nothing).estimate is None
    pose = at(2.0, 3.5, 0.0)
    localizer.set_pose(pose, default_covariance(localizer.params))
    located = localizer.step(nothing)
    assert located.estimate is not None
    assert located.estimate.pose.distance_to(pose) < 0.1


FEW = 0.5 * np.column_stack([np.cos(np.arange(6.0)), np.sin(np.arange(6.0))])


def blind(localizer: MapLocalizer, poses: list[Pose2], first: int) -> list[Located]:
    """Use scans in which six of 180 beams have an echo, of things near the robot."""
    return [
        localizer.step(ScanView(FEW, pose, number * SCAN_NS, beams=180))
        for number, pose in enumerate(poses, first)
    ]


def followed() -> MapLocalizer:
    """Return a localizer after 9 steps from the left of the map."""
    localizer = MapLocalizer(AmclParams(), CELLS, SPEC)
    localizer.set_pose(at(1.0, 3.5, 0.0), default_covariance(localizer.params))
    steps(localizer, line(1.0, 3.5, 0.0, 9), Pose2(0, 0, 0))
    return localizer


def test_a_robot_at_rest_that_sees_nothing_stays_localized() -> None:
    localizer = followed()
    seen = blind(localizer, [line(1.0, 3.5, 0.0, 9)[-1]] * 50, 9)
    assert {each.state for each in seen} == {LocalizationState.LOCALIZED}
    assert seen[-1].match is None


def test_without_echoes_the_pose_grows_uncertain_and_is_confirmed_again() -> None:
    localizer = followed()
    last = line(1.0, 3.5, 0.0, 9)[-1]
    away = [last @ Pose2(0.12 * k, 0.0, 0.0) for k in range(1, 14)]
    seen = blind(localizer, [*away, *away[::-1]], 9)
    spreads = [each.estimate.stddev_m for each in seen if each.estimate is not None]
    assert spreads[12] > 2 * spreads[0]
    assert seen[4].state is LocalizationState.LOCALIZED
    correction = seen[4].map_T_odom
    assert correction is not None
    assert (correction @ away[4]).distance_to(away[4]) < 0.06
    again = steps(localizer, [last] * 40, Pose2(0, 0, 0), 100)
    assert again.state is LocalizationState.LOCALIZED
    assert off(again, last, Pose2(0, 0, 0)) < 0.08


def test_a_pose_that_drifts_without_echoes_is_lost_as_uncertain() -> None:
    localizer = followed()
    last = line(1.0, 3.5, 0.0, 9)[-1]
    turns = [last @ Pose2(0.0, 0.0, 0.4 * (k % 2)) for k in range(60)]
    forth = [turn @ Pose2(0.12 * (k % 8), 0.0, 0.0) for k, turn in enumerate(turns)]
    seen = blind(localizer, forth, 9)
    assert seen[-1].state is LocalizationState.LOST
    assert seen[-1].cause is DoubtCause.UNCERTAIN
    assert seen[-1].estimate is not None
    assert seen[-1].estimate.stddev_m > localizer.params.lost_stddev_m
    again = steps(localizer, [forth[-1]] * 60, Pose2(0, 0, 0), 200)
    assert again.state is LocalizationState.LOCALIZED
    assert again.cause is None


def test_without_echoes_the_spread_is_that_of_the_odometry_if_it_states_one() -> None:
    """The alphas would double it in half a metre."""
    localizer = followed()
    last = line(1.0, 3.5, 0.0, 9)[-1]
    spreads = []
    for k in range(1, 40):
        pose = last @ Pose2(0.12 * k, 0.0, 0.0)
        covariance = np.diag([2e-5 * k, 2e-5 * k, 1e-7 * k])
        stamp_ns = (9 + k) * SCAN_NS
        found = localizer.step(ScanView(FEW, pose, stamp_ns, 180, covariance))
        assert found.state is LocalizationState.LOCALIZED
        assert found.estimate is not None
        spreads.append(found.estimate.stddev_m)
    assert spreads[0] < spreads[-1] < 0.4


def test_the_noise_of_a_motion_is_what_it_adds_to_the_covariance() -> None:
    before, after = Pose2(1.0, 2.0, 0.5), Pose2(1.0, 2.0, 0.5) @ Pose2(0.4, 0.0, 0.1)
    added = np.diag([0.01, 0.002, 0.003])
    c, s = math.cos(after.yaw), math.sin(after.yaw)
    odom_R_base = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    jacobian = np.array(
        [[1, 0, before.y - after.y], [0, 1, after.x - before.x], [0, 0, 1]]
    )
    first = np.diag([0.1, 0.2, 0.05])
    second = jacobian @ first @ jacobian.T + odom_R_base @ added @ odom_R_base.T
    found = noise_of_motion(before, first, after, second)
    assert found == pytest.approx(added, abs=1e-12)
    assert noise_of_motion(before, first, after, first) is None  # a constant one


def test_a_robot_that_people_surrounded_continues_where_it_was() -> None:
    """Also where furniture was moved, and other places fit as well as its own."""
    localizer = followed()
    last = line(1.0, 3.5, 0.0, 9)[-1]
    angles = np.linspace(0, 6.2, 120)
    crowd = 0.7 * np.column_stack([np.cos(angles), np.sin(angles)])
    for number in range(9, 40):
        located = localizer.step(ScanView(crowd, last, number * SCAN_NS, beams=180))
    assert located.state is LocalizationState.LOST
    assert located.cause is DoubtCause.CONTRADICTED
    again = steps(localizer, [last] * 30, Pose2(0, 0, 0), 40)
    assert again.state is LocalizationState.LOCALIZED
    assert off(again, last, Pose2(0, 0, 0)) < 0.08


def test_covariances_of_initial_poses_are_checked() -> None:
    assert is_usable(np.diag([0.1, 0.1, 0.1]))
    assert not is_usable(np.zeros((3, 3)))
    assert not is_usable(np.diag([1.0, -1.0, 1.0]))
    assert not is_usable(np.full((3, 3), math.nan))


def test_equal_seeds_give_equal_particles() -> None:
    found = []
    for _ in range(2):
        localizer = MapLocalizer(AmclParams(seed=5), CELLS, SPEC)
        steps(localizer, line(1.0, 3.5, 0.0, 5), Pose2(0, 0, 0))
        found.append(localizer.filter.particles.poses)
    np.testing.assert_array_equal(*found)
