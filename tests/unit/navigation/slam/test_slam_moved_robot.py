"""A robot that was carried away, or whose place in the map is unknown."""

import math
from collections.abc import Iterable

import numpy as np
import pytest

from navette.geometry import Pose2
from navette.navigation.slam import Slam, SlamParams
from navette.navigation.slam.match_status import MatchStatus
from slam_office import Segments, box, scan_at

HERE = Pose2(0.0, 0.0, 0.0)
#: Two rooms without a door between them.
ROOM = [*box(0.0, 0.0, 6.0, 5.0), *box(0.5, 4.0, 1.5, 0.6), *box(4.8, 0.3, 0.7, 1.2)]
OTHER = [
    *box(20.0, 0.0, 7.5, 4.0),
    *box(21.0, 0.2, 0.8, 0.8),
    *box(26.0, 3.0, 1.0, 0.5),
]
ROOMS = np.array(ROOM + OTHER)


class Robot:
    """A robot that drives; being carried does not turn its wheels."""

    def __init__(self, walls: Segments, pose: Pose2, seed: int = 0) -> None:
        self.walls, self.pose = walls, pose
        self.odometry = Pose2(7.0, -3.0, 2.0)
        self._noise = np.random.default_rng(seed)
        self._count = 0

    def step(self, slam: Slam, motion: Pose2 = HERE) -> bool:
        """Drive, scan, and return whether the scan was matched."""
        self.pose, self.odometry = self.pose @ motion, self.odometry @ motion
        self._count += 1
        scan = scan_at(self.walls, self.pose, noise=self._noise)
        return slam.add(self._count * 10**8, scan, self.odometry).is_matched

    def drive(self, slam: Slam, motions: Iterable[Pose2]) -> list[bool]:
        return [self.step(slam, motion) for motion in motions]


def ahead(distance_m: float) -> list[Pose2]:
    return [Pose2(0.1, 0.0, 0.0)] * round(distance_m / 0.1)


def turned(angle_rad: float) -> list[Pose2]:
    count = math.ceil(abs(angle_rad) / 0.1)
    return [Pose2(0.0, 0.0, angle_rad / count)] * count


AROUND = [*ahead(2.5), *turned(2.0), *ahead(1.5), *turned(2.0), *ahead(1.0)]


def mapped(walls: Segments, start: Pose2, motions: list[Pose2]) -> Slam:
    slam = Slam(SlamParams(), start)
    Robot(walls, start, seed=1).drive(slam, [HERE, *motions])
    return slam


def error_m(slam: Slam, robot: Robot) -> float:
    return slam.trajectory()[-1][1].distance_to(robot.pose)


@pytest.mark.parametrize("place", [Pose2(23.0, 1.5, 0.3), Pose2(25.0, 2.5, -2.0)])
def test_a_robot_carried_to_an_unmapped_room_is_lost_until_it_is_back(
    place: Pose2,
) -> None:
    robot = Robot(ROOMS, Pose2(1.5, 1.5, 0.2))
    slam = Slam(SlamParams(), robot.pose)
    assert all(robot.drive(slam, [HERE, *AROUND])[1:])
    keys, robot.pose = len(slam.graph), place
    there = robot.drive(slam, [*[HERE] * 25, *ahead(1.0), *turned(1.0)])
    assert not any(there)
    assert slam.unmatched_in_a_row >= slam.params.lost_scans
    assert len(slam.graph) == keys
    robot.pose = Pose2(2.0, 2.0, -1.0)
    back = robot.drive(slam, [*[HERE] * 10, *turned(0.8), *ahead(0.8)])
    assert all(back[-8:])
    assert error_m(slam, robot) < 0.05
    assert slam.unmatched_in_a_row == 0
    assert len(slam.graph) > keys


def test_an_unmapped_room_that_looks_like_the_mapped_one_is_not_claimed() -> None:
    """Its walls fit, its furniture stands elsewhere."""
    twin = [*box(20.0, 0.0, 6.0, 5.0), *box(23.5, 0.3, 0.9, 0.7)]
    walls = np.array([*ROOM, *twin])
    robot = Robot(walls, Pose2(1.5, 1.5, 0.2))
    slam = Slam(SlamParams(), robot.pose)
    robot.drive(slam, [HERE, *AROUND])
    for place in (Pose2(22.0, 2.5, 1.0), Pose2(24.5, 3.5, -2.5), Pose2(21.0, 2.0, 0.3)):
        robot.pose = place
        assert not any(robot.drive(slam, [HERE] * 40)[30:])
    robot.pose = Pose2(2.0, 2.0, -1.0)
    assert all(robot.drive(slam, [*[HERE] * 10, *turned(0.8), *ahead(0.8)])[-8:])


def test_a_robot_carried_within_its_map_is_found() -> None:
    robot = Robot(ROOMS, Pose2(1.5, 1.5, 0.2))
    slam = Slam(SlamParams(), robot.pose)
    robot.drive(slam, [HERE, *AROUND])
    robot.pose = Pose2(3.5, 3.5, -2.5)
    robot.drive(slam, [*[HERE] * 22, *ahead(0.5)])
    assert slam.unmatched_in_a_row == 0
    assert error_m(slam, robot) < 0.05


def test_a_wrong_start_pose_is_corrected() -> None:
    known = mapped(ROOMS, Pose2(1.5, 1.5, 0.2), AROUND).graph
    slam = Slam(SlamParams(), Pose2(4.0, 3.0, 2.0), graph=known, is_mapping=False)
    robot = Robot(ROOMS, Pose2(1.8, 1.4, 0.0))
    states = robot.drive(slam, [HERE] * 25)
    assert not any(states[:10])
    assert states[-1]
    assert error_m(slam, robot) < 0.05


def test_an_empty_room_that_fits_after_half_a_turn_is_not_claimed() -> None:
    walls = np.array(box(0.0, 0.0, 6.0, 4.0))
    known = mapped(walls, Pose2(1.5, 1.5, 0.2), AROUND).graph
    slam = Slam(SlamParams(), None, graph=known, is_mapping=False)
    robot = Robot(walls, Pose2(2.0, 1.5, 0.0))
    assert not any(robot.drive(slam, [HERE, *AROUND]))
    asymmetric = Slam(
        SlamParams(),
        None,
        graph=mapped(ROOMS, Pose2(1.5, 1.5, 0.2), AROUND).graph,
        is_mapping=False,
    )
    assert Robot(ROOMS, Pose2(2.0, 1.5, 0.0)).step(asymmetric)


def alike() -> Segments:
    """Return two rooms that are the same, on a corridor whose ends differ."""
    walls = [(-3.0, 0.0, 1.6, 0.0), (2.6, 0.0, 7.6, 0.0), (8.6, 0.0, 14.0, 0.0)]
    walls += [(-3.0, 2.0, 14.0, 2.0), (-3.0, 0.0, -3.0, 2.0), (14.0, 0.0, 14.0, 2.0)]
    walls += box(-2.4, 1.4, 1.0, 0.6) + box(12.0, 0.0, 0.4, 0.5)
    for x in (0.0, 6.0):
        walls += [
            (x, 0.0, x, -4.0),
            (x, -4.0, x + 4.2, -4.0),
            (x + 4.2, -4.0, x + 4.2, 0.0),
        ]
        walls += box(x + 0.2, -2.0, 0.5, 1.2) + box(x + 3.0, -3.8, 1.0, 0.5)
    return np.array(walls)


TOUR_OF_BOTH = [
    *ahead(3.1), *turned(math.pi), *ahead(3.1), *turned(-math.pi / 2), *ahead(6.0),
    *turned(-math.pi / 2), *ahead(3.1), *turned(math.pi), *ahead(3.1),
]  # fmt: skip


def test_a_room_is_distinguished_from_one_without_its_cupboard() -> None:
    """Nearly all surfaces fit in both rooms; the cupboard contradicts one of them."""
    walls, south = np.array([*alike(), *box(6.8, -3.2, 0.6, 0.5)]), -math.pi / 2
    known = mapped(walls, Pose2(2.1, 1.0, south), TOUR_OF_BOTH).graph
    for place in (Pose2(8.1, -2.0, south), Pose2(7.6, -1.2, 0.4)):
        slam = Slam(SlamParams(), None, graph=known, is_mapping=False)
        robot = Robot(walls, place)
        assert robot.step(slam)
        assert error_m(slam, robot) < 0.05


def test_rooms_that_look_alike_are_claimed_once_they_are_distinguishable() -> None:
    walls, south = alike(), -math.pi / 2
    tour = [*ahead(3.1), *turned(math.pi), *ahead(3.1), *turned(south), *ahead(6.0)]
    tour += [*turned(south), *ahead(3.1), *turned(math.pi), *ahead(3.1)]
    tour += [*turned(south), *ahead(4.0), *turned(math.pi), *ahead(12.0)]
    known = mapped(walls, Pose2(2.1, 1.0, south), tour).graph
    slam = Slam(SlamParams(), None, graph=known, is_mapping=False)
    robot = Robot(walls, Pose2(8.1, -2.0, south))
    inside = robot.drive(slam, [*turned(math.pi), *ahead(0.5)])
    assert not any(inside)
    assert slam.match_status is MatchStatus.LOST_AMBIGUOUS
    out = robot.drive(slam, [*ahead(2.4), *turned(south), *ahead(4.0)])
    first = out.index(True)
    assert all(out[first:])
    assert error_m(slam, robot) < 0.05
