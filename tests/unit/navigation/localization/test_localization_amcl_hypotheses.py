"""AMCL in rooms that look alike: certainty only where one place explains the scans."""

import math

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Pose2
from navette.navigation.grids import GridSpec
from navette.navigation.localization.amcl import AmclParams
from navette.navigation.localization.amcl.confidence import LocalizationState
from navette.navigation.localization.amcl.global_search import search_map
from navette.navigation.localization.amcl.hypotheses import hypotheses
from navette.navigation.localization.amcl.likelihood_field import LikelihoodField
from navette.navigation.localization.amcl.localizer import (
    Located,
    MapLocalizer,
    ScanView,
    default_covariance,
)

CELL_M, ROOM_M = 0.05, 5.0
SPEC = GridSpec(CELL_M, 200, 100, Pose2(0.0, 0.0, 0.0))


def twin_rooms(*, mark: bool) -> NDArray[np.int8]:
    """Two rooms of 5 m × 5 m with equal furniture; ``mark``: a locker in the second."""
    cells = np.zeros(SPEC.shape, np.int8)
    for left in (0, 100):
        room = cells[:, left : left + 100]
        room[:2], room[-2:], room[:, :2], room[:, -2:] = 100, 100, 100, 100
        room[20:30, 20:50] = 100
        room[70:90, 60:70] = 100
    if mark:
        cells[85:98, 102:112] = 100
    return cells


def scan(cells: NDArray[np.int8], pose: Pose2) -> NDArray[np.float64]:
    """Return where 90 beams over 180 degrees end (N, 2), base frame."""
    angles = np.linspace(-math.pi / 2, math.pi / 2, 90)
    along = np.arange(0.0, 8.0, CELL_M / 2)
    rays = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    points = rays[:, None] * along[:, None]
    column, row = np.floor(pose.apply(points.reshape(-1, 2)) / CELL_M).astype(int).T
    inside = (row >= 0) & (row < 100) & (column >= 0) & (column < 200)
    hit = np.zeros(len(row), np.bool_)
    hit[inside] = cells[row[inside], column[inside]] == 100
    return points[np.arange(90), hit.reshape(90, -1).argmax(axis=1)]


def drive(
    localizer: MapLocalizer, cells: NDArray[np.int8], poses: list[Pose2]
) -> list[Located]:
    return [
        localizer.step(ScanView(scan(cells, pose), pose, number * 200_000_000))
        for number, pose in enumerate(poses)
    ]


# Below the locker's view at first, then turning towards it.
AHEAD = [Pose2(6.0 + 0.1 * k, 2.4, 0.0) for k in range(15)]
TURN = [Pose2(7.4, 2.4, 0.1 * k) for k in range(1, 26)]


def test_cells_that_fit_another_room_better_do_not_decide() -> None:
    """The walls of the robot's own room are drawn a cell too far away."""
    cells = twin_rooms(mark=False)
    drawn = cells.copy()
    drawn[1, 2:98] = drawn[98, 2:98] = drawn[2:98, 1] = drawn[2:98, 98] = 0
    pose, other = Pose2(2.4, 2.4, 0.5), Pose2(7.4, 2.4, 0.5)
    points = scan(cells, pose)
    field = LikelihoodField.of(drawn, SPEC, sigma=0.15, random=0.1, reach_m=2.0)
    own, wrong = field.scores(np.array([pose, other]), points)
    assert wrong > own + 0.012
    found = hypotheses(field, points, other)
    away = [Pose2(*each).distance_to(pose) for each in found.poses.tolist()]
    assert len(found.poses) == 2
    assert min(away) < 0.1


def test_neighbours_of_a_place_that_fits_do_not_displace_the_others() -> None:
    """Twelve equal rooms: all of them are candidates."""
    room = twin_rooms(mark=False)[:, :100]
    cells = np.tile(room, (3, 4))
    spec = GridSpec(CELL_M, 400, 300, Pose2(0.0, 0.0, 0.0))
    field = LikelihoodField.of(cells, spec, sigma=0.15, random=0.1, reach_m=2.0)
    points = scan(twin_rooms(mark=False), Pose2(2.4, 2.4, 0.5))
    found = search_map(field, points)
    for row in range(3):
        for column in range(4):
            there = np.array([2.4 + ROOM_M * column, 2.4 + ROOM_M * row])
            away = np.hypot(*(found.poses[:, :2] - there).T)
            assert (away < 0.15).any()


def test_equal_rooms_are_not_claimed() -> None:
    cells = twin_rooms(mark=False)
    localizer = MapLocalizer(AmclParams(seed=3), cells, SPEC)
    found = drive(localizer, cells, [*AHEAD, *TURN])
    assert {each.state for each in found} == {LocalizationState.LOCALIZING}
    assert found[-1].hypotheses == 2
    assert all(each.map_T_odom is None for each in found)


def test_what_distinguishes_the_rooms_decides() -> None:
    cells = twin_rooms(mark=True)
    localizer = MapLocalizer(AmclParams(seed=3), cells, SPEC)
    found = drive(localizer, cells, [*AHEAD, *TURN, *[TURN[-1]] * 15])
    assert found[12].state is LocalizationState.LOCALIZING
    assert found[-1].state is LocalizationState.LOCALIZED
    assert found[-1].hypotheses == 1
    correction = found[-1].map_T_odom
    assert correction is not None
    assert (correction @ TURN[-1]).distance_to(TURN[-1]) < 0.1


def test_a_given_pose_decides() -> None:
    cells = twin_rooms(mark=False)
    localizer = MapLocalizer(AmclParams(seed=3), cells, SPEC)
    localizer.set_pose(AHEAD[0], default_covariance(localizer.params))
    found = drive(localizer, cells, AHEAD)
    assert found[-1].state is LocalizationState.LOCALIZED


def test_a_pose_in_the_wrong_room_is_doubted_once_the_scans_differ() -> None:
    """The given pose is in the first room; the locker is in the second one.

    A stretch of driving with the locker in view decides, not one scan of it.
    """
    cells = twin_rooms(mark=True)
    localizer = MapLocalizer(AmclParams(seed=2), cells, SPEC)
    wrong = Pose2(AHEAD[0].x - 5.0, AHEAD[0].y, AHEAD[0].yaw)
    localizer.set_pose(wrong, default_covariance(AmclParams()))
    towards = [TURN[-1] @ Pose2(0.1 * k, 0.0, 0.0) for k in range(1, 20)]
    back = towards[::-1]
    seen = drive(localizer, cells, [*AHEAD, *TURN, *towards, *back])
    states = [each.state for each in seen]
    assert states[10] is LocalizationState.LOCALIZED
    assert LocalizationState.LOCALIZING in states[10:]
    assert states[-1] is LocalizationState.LOCALIZED
    last = seen[-1].map_T_odom
    assert last is not None
    assert (last @ back[-1]).distance_to(back[-1]) < 0.3


def test_moved_furniture_does_not_move_the_robot_to_another_room() -> None:
    """Without its table the second room looks like the first one.

    A box that no room of the map has stands there now. The first room explains the
    scans better, and the robot came from nowhere else.
    """
    drawn, actual = twin_rooms(mark=False), twin_rooms(mark=False)
    drawn[15:65, 168:190] = 100
    actual[62:70, 152:160] = 100
    localizer = MapLocalizer(AmclParams(seed=3), drawn, SPEC)
    path = [Pose2(5.7 + 0.1 * k, 2.4, 0.0) for k in range(14)]
    localizer.set_pose(path[0], default_covariance(AmclParams()))
    turn = [path[-1] @ Pose2(0.0, 0.0, 0.1 * k) for k in range(1, 20)]
    poses = [*path, *turn, *turn[::-1], *[path[-1]] * 20]
    found = drive(localizer, actual, poses)
    assert {each.state for each in found[5:]} == {LocalizationState.LOCALIZED}
    for located, pose in zip(found[5:], poses[5:], strict=True):
        assert located.map_T_odom is not None
        assert (located.map_T_odom @ pose).distance_to(pose) < 0.3
