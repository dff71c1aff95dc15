"""A scanner that reaches nothing, or too little to match."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from navette.geometry import Pose2, angle_difference
from navette.navigation.slam import Slam, SlamParams
from navette.navigation.slam.match_status import MatchStatus
from slam_office import Segments, box, scan_at

HERE = Pose2(0.0, 0.0, 0.0)
RANGE_M = 3.5
#: A hall of which the scanner sees nothing from the middle.
HALL = np.array(
    [
        *box(0.0, 0.0, 24.0, 16.0),
        *box(3.0, 2.0, 1.0, 1.0),
        *box(20.0, 12.5, 1.2, 0.8),
        *box(2.0, 12.0, 0.8, 0.8),
        *box(20.0, 3.0, 1.5, 0.5),
    ]
)
ACROSS = [(2.0, 5.0), (2.0, 2.5), (12.0, 8.0), (21.0, 11.0), (12.0, 8.0), (2.0, 4.0)]
ACROSS += [(2.0, 2.5)]
ALONG_A_WALL = [(2.0, 1.5), (22.0, 1.5)]
FROM_THE_MIDDLE = [(12.0, 8.0), (3.0, 4.5), (2.0, 3.0)]


def path(corners: list[tuple[float, float]]) -> list[Pose2]:
    """Return poses 0.1 m or 0.2 rad apart along corners."""
    poses: list[Pose2] = []
    for (x1, y1), (x2, y2) in pairwise(corners):
        heading = math.atan2(y2 - y1, x2 - x1)
        poses = poses or [Pose2(x1, y1, heading)]
        while abs(turn := angle_difference(heading, poses[-1].yaw)) > 1e-6:
            poses.append(Pose2(x1, y1, poses[-1].yaw + max(-0.2, min(0.2, turn))))
        count = round(math.hypot(x2 - x1, y2 - y1) / 0.1)
        for k in range(1, count + 1):
            x, y = x1 + k / count * (x2 - x1), y1 + k / count * (y2 - y1)
            poses.append(Pose2(x, y, heading))
    return poses


class Robot:
    """A robot whose odometry measures 4 % too much and turns by 0.005 rad per metre."""

    def __init__(self, pose: Pose2, walls: Segments = HALL) -> None:
        self.pose, self.odometry = pose, HERE
        self.walls = walls
        self._noise = np.random.default_rng(3)
        self._count = 0

    def step(self, slam: Slam, pose: Pose2) -> float:
        """Move to a pose, scan, and return the error of the estimate, m."""
        x, y, turn = self.pose.inverse() @ pose
        turn += 0.005 * math.hypot(x, y)
        self.odometry = self.odometry @ Pose2(1.04 * x, 1.04 * y, turn)
        self.pose = pose
        self._count += 1
        scan = scan_at(self.walls, pose, noise=self._noise, range_m=RANGE_M)
        self.estimate = slam.add(self._count * 10**8, scan, self.odometry)
        return self.estimate.map_T_base.distance_to(pose)

    def drive(self, slam: Slam, corners: list[tuple[float, float]]) -> list[float]:
        return [self.step(slam, pose) for pose in path(corners)]

    @property
    def stddev_m(self) -> float:
        return math.sqrt(np.trace(self.estimate.covariance[:2, :2]))


def begin(corners: list[tuple[float, float]], **params: float) -> tuple[Slam, Robot]:
    start = path(corners)[0]
    return Slam(SlamParams(**params), start), Robot(start)


def test_odometry_leads_through_a_hall_and_the_walls_correct_it() -> None:
    slam, robot = begin(ACROSS)
    errors, deviations, seen = [], [], []
    for pose in path(ACROSS):
        errors.append(robot.step(slam, pose))
        deviations.append(robot.stddev_m)
        seen.append(slam.match_status)
    assert not any(each.is_lost for each in seen)
    middle = slice(
        seen.index(MatchStatus.NO_ECHOES), seen.index(MatchStatus.NOTHING_MAPPED)
    )
    assert set(seen[middle]) == {MatchStatus.NO_ECHOES}
    grown = np.diff(deviations[middle])
    assert (grown > -1e-9).all()
    assert deviations[middle][-1] > 0.5
    # The covariance states the errors.
    assert all(e < 3.0 * d + 0.02 for e, d in zip(errors, deviations, strict=True))
    assert max(errors) > 0.5
    assert errors[-1] < 0.1
    assert seen[-1] is MatchStatus.MATCHED
    # What was driven in the hall is corrected, too.
    driven = [pose for _, pose in slam.trajectory()]
    away = [a.distance_to(b) for a, b in zip(driven, path(ACROSS), strict=True)]
    assert max(away) < 0.5 * max(errors)


def test_a_robot_that_stands_without_echoes_stays_as_certain_as_it_was() -> None:
    slam, robot = begin(ACROSS)
    robot.drive(slam, ACROSS[:3])
    before = robot.stddev_m
    for _ in range(600):
        robot.step(slam, robot.pose)
    assert slam.match_status is MatchStatus.NO_ECHOES
    assert robot.stddev_m == pytest.approx(before, rel=0.01)


def test_a_robot_whose_position_is_too_uncertain_is_lost() -> None:
    slam, robot = begin(ACROSS, lost_stddev_m=0.3)
    states = []
    for pose in path(ACROSS[:4]):
        robot.step(slam, pose)
        states.append(slam.match_status)
    assert MatchStatus.LOST_UNCERTAIN in states
    keys = len(slam.graph)
    robot.drive(slam, ACROSS[3:])
    assert slam.match_status is MatchStatus.MATCHED
    assert len(slam.graph) > keys


def test_too_few_echoes_contradict_nothing() -> None:
    """Somebody stands between the robot and a wall; all else is out of reach."""
    walls = np.array([*box(0.0, 0.0, 6.0, 5.0), *box(4.8, 0.3, 0.7, 1.2)])
    robot = Robot(Pose2(1.5, 1.5, 0.0), walls)
    slam = Slam(SlamParams(), robot.pose)
    robot.drive(slam, [(1.5, 1.5), (2.5, 1.5)])
    scan = scan_at(walls, robot.pose, range_m=RANGE_M)
    few = np.full_like(scan.ranges, np.inf)
    few[176:184] = 1.0
    for k in range(30):
        stamp_ns = (100 + k) * 10**8
        slam.add(stamp_ns, replace(scan, ranges=few), robot.odometry)
    assert slam.match_status is MatchStatus.NO_ECHOES
    assert slam.contradicted_in_a_row == 0


def test_along_a_single_wall_the_error_stays_within_the_stated_one() -> None:
    wall = np.array([(-50.0, 0.0, 50.0, 0.0)])
    start = path(ALONG_A_WALL)[0]
    slam, robot = Slam(SlamParams(), start), Robot(start, wall)
    for pose in path(ALONG_A_WALL):
        robot.step(slam, pose)
        found = robot.estimate.map_T_base
        assert abs(found.y - pose.y) < 0.1
        assert abs(found.x - pose.x) < 3.0 * robot.stddev_m + 0.05
        assert not slam.match_status.is_lost


@pytest.fixture(scope="module")
def known() -> Slam:
    """The walls of the hall, mapped with an exact odometry."""
    corners = [(2.0, 2.0), (22.0, 2.0), (22.0, 14.0), (2.0, 14.0), (2.0, 2.0)]
    slam = Slam(SlamParams(), path(corners)[0])
    for k, pose in enumerate(path(corners)):
        slam.add(k * 10**8, scan_at(HALL, pose, range_m=RANGE_M), pose)
    return slam


def test_a_known_map_is_used_again_after_a_stretch_without_echoes(known: Slam) -> None:
    start = path(ACROSS)[0]
    slam = Slam(SlamParams(), start, graph=known.graph, is_mapping=False)
    errors = Robot(start).drive(slam, ACROSS)
    assert max(errors) > 0.3
    assert errors[-1] < 0.05
    assert not slam.match_status.is_lost


def test_a_start_in_a_known_map_without_echoes_is_used(known: Slam) -> None:
    robot = Robot(path(FROM_THE_MIDDLE)[0])
    start = robot.pose @ Pose2(0.2, -0.1, 0.05)
    slam = Slam(SlamParams(), start, graph=known.graph, is_mapping=False)
    robot.step(slam, robot.pose)
    assert slam.match_status is MatchStatus.NO_ECHOES
    assert robot.stddev_m > 0.3
    assert robot.drive(slam, FROM_THE_MIDDLE)[-1] < 0.05
    assert slam.match_status is MatchStatus.MATCHED


def test_a_robot_that_is_searched_for_states_how_little_is_known(known: Slam) -> None:
    slam = Slam(SlamParams(), None, graph=known.graph, is_mapping=False)
    robot = Robot(Pose2(12.0, 8.0, 0.0))
    for _ in range(25):
        error = robot.step(slam, robot.pose)
    assert slam.match_status is MatchStatus.LOST_NO_ECHOES
    assert error < 2.0 * robot.stddev_m
    assert robot.estimate.covariance[2, 2] > 3.0
