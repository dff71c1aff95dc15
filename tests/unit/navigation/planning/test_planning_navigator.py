"""When to plan again, when to keep the path, when to give up."""

import math

import numpy as np
import pytest
from planning_worlds import empty_map, fill

from navette.geometry import Pose2
from navette.navigation.planning import (
    Goal,
    Navigator,
    NewMap,
    Outcome,
    Phase,
    PlannerParams,
    RobotMotion,
    State,
)
from navette.navigation.planning.path_progress import PathProgress
from navette.navigation.planning.path_shape import (
    headed,
    joined,
    resample,
    turn_in_place,
)

PERIOD_NS = 500_000_000
BODY_OF_HALF_A_METRE = (0.25, 0.25, -0.25, 0.25, -0.25, -0.25, 0.25, -0.25)


class Drive:
    """A robot that follows what the navigator publishes, pose by pose."""

    def __init__(self, occupancy: np.ndarray | None = None, **params: object) -> None:
        self.occupancy, self.spec = empty_map(10, 8)
        if occupancy is not None:
            self.occupancy = occupancy
        self.navigator = Navigator(PlannerParams(**params))
        self.navigator.set_map(NewMap(self.occupancy, self.spec))
        self.pose, self.now_ns, self.moving = Pose2(1, 4, 0), 0, True
        self.published: list[np.ndarray] = []
        self.path = np.empty((0, 3))

    def send(self, x: float, y: float, yaw: float | None = None) -> None:
        self.navigator.set_goal(Goal(x, y, yaw), self.now_ns)

    def step(self, *, stale: bool = False) -> None:
        """Half a second: the robot moves along its path by five poses."""
        self.now_ns += PERIOD_NS
        moves = self.moving and len(self.path) > 1
        if moves:
            away = np.hypot(*(self.path[:, :2] - self.pose[:2]).T)
            at = min(int(np.argmin(away)) + 5, len(self.path) - 1)
            self.pose = Pose2(*self.path[at].tolist())
        robot = RobotMotion(self.pose, 1.0 if moves else 0.0, 0.0)
        self.navigator.step(robot, self.now_ns, stale=stale)
        path = self.navigator.take_path()
        if path is not None:
            self.published.append(path)
            self.path = path

    def steps(self, count: int) -> None:
        for _ in range(count):
            self.step()

    def change_map(self, x, y, value: int = 100) -> None:
        self.occupancy = self.occupancy.copy()
        fill(self.occupancy, self.spec, x, y, value)
        self.navigator.set_map(NewMap(self.occupancy, self.spec))

    @property
    def message(self) -> str:
        return self.navigator.report.message


def test_a_goal_is_driven_to_on_one_path_and_reached() -> None:
    drive = Drive()
    drive.step()
    assert (drive.message, drive.published) == (Phase.WAITING_FOR_GOAL, [])
    drive.send(8, 4)
    assert drive.navigator.report.state is State.WAITING_FOR_ROBOT
    drive.step()
    assert drive.message == Phase.FOLLOWING
    assert drive.navigator.report.distance_left_m == pytest.approx(7.0)
    drive.steps(20)
    assert drive.message == Phase.REACHED
    assert drive.navigator.report.result == "reached"
    assert drive.navigator.report.state is State.WAITING_FOR_GOAL
    assert [len(p) > 0 for p in drive.published] == [True, False], "then stop"
    drive.steps(3)
    assert drive.message == Phase.REACHED
    assert len(drive.published) == 2


def test_rest_near_the_goal_counts_as_reached() -> None:
    drive = Drive(path_end_tolerance_m=0.05)
    drive.pose, drive.moving = Pose2(7.7, 4, 0), False
    drive.send(8, 4)
    drive.step()
    assert drive.message == Phase.FOLLOWING
    drive.steps(2)
    assert drive.message == Phase.REACHED


def test_a_goal_heading_must_be_reached_too() -> None:
    drive = Drive()
    drive.pose, drive.moving = Pose2(8, 4, 0), False
    drive.send(8, 4, math.pi / 2)
    drive.steps(4)
    assert drive.message == Phase.FOLLOWING
    drive.pose = Pose2(8, 4, 1.5)
    drive.step()
    assert drive.message == Phase.REACHED


def test_goals_wait_for_map_and_odometry_with_a_status() -> None:
    navigator = Navigator(PlannerParams())
    navigator.set_goal(Goal(3, 3), 0)
    navigator.step(None, 1, stale=True)
    assert navigator.report.message == Phase.WAITING_FOR_ODOMETRY
    robot = RobotMotion(Pose2(1, 1, 0), 0, 0)
    navigator.step(robot, 2, stale=False)
    assert navigator.report.message == Phase.WAITING_FOR_MAP
    navigator.set_map(NewMap(*empty_map(5, 5)))
    navigator.step(robot, 3, stale=False)
    assert navigator.report.message == Phase.FOLLOWING


def test_stale_odometry_stops_and_fresh_odometry_continues() -> None:
    drive = Drive()
    drive.send(8, 4)
    drive.steps(3)
    drive.step(stale=True)
    assert drive.message == Outcome.STALE_ODOMETRY
    assert drive.navigator.report.failed
    assert not len(drive.published[-1])
    drive.steps(20)
    assert drive.message == Phase.REACHED


@pytest.mark.parametrize(
    ("goal", "outcome"),
    [
        ((math.nan, 1.0), Outcome.GOAL_NOT_FINITE),
        ((500.0, 1.0), Outcome.GOAL_OUTSIDE_MAP),
    ],
)
def test_a_refused_goal_stops_the_robot_and_counts(goal, outcome: Outcome) -> None:
    drive = Drive()
    drive.send(8, 4)
    drive.steps(3)
    drive.send(*goal)
    drive.step()
    report = drive.navigator.report
    assert (report.message, report.result, report.goal_id) == (outcome, outcome, 2)
    assert not len(drive.published[-1])
    drive.send(*goal)
    drive.step()
    assert drive.navigator.report.goal_id == 3
    drive.send(8, 4)
    drive.steps(20)
    assert drive.message == Phase.REACHED, "alive"


def test_a_failure_publishes_an_empty_path_in_any_case() -> None:
    drive = Drive()
    drive.send(500, 1)
    drive.step()
    assert [len(p) for p in drive.published] == [0]


def test_a_new_goal_replaces_the_old_at_once() -> None:
    drive = Drive()
    drive.send(8, 4)
    drive.steps(3)
    drive.send(1, 1)
    drive.step()
    np.testing.assert_allclose(drive.published[-1][-1, :2], (1, 1))
    assert len(drive.published) == 2, "no stop in between"


def test_a_path_that_becomes_blocked_is_replaced() -> None:
    drive = Drive()
    drive.send(9, 4)
    drive.steps(4)
    drive.change_map((6, 6.2), (2, 5))
    drive.step()
    assert drive.navigator.report.replans == 1
    assert len(drive.published) == 2
    drive.steps(40)
    assert drive.message == Phase.REACHED


def blocked_before_a_door(*, other_way: bool) -> Drive:
    """A robot whose controller refuses the path through a door 5 cm to each side."""
    drive = Drive(footprint_m=BODY_OF_HALF_A_METRE)
    drive.pose, drive.moving = Pose2(4, 4, 0), False
    drive.change_map((5.0, 5.2), (4.3, 8))
    drive.change_map((5.0, 5.2), (1.5 if other_way else 0, 3.7))
    drive.send(6, 4)
    drive.step()
    return drive


def refuse(drive: Drive, times: int) -> None:
    for _ in range(times):
        drive.navigator.note_blocked()
        drive.steps(2)


def test_where_plans_take_long_one_that_is_blocked_far_ahead_is_replaced_later(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("navette.navigation.planning.navigator._MANY_CELLS", -1)
    drive = Drive(empty_map(30, 8)[0])
    drive.spec = empty_map(30, 8)[1]
    drive.navigator.set_map(NewMap(drive.occupancy, drive.spec))
    drive.send(28, 4)
    drive.steps(2)
    planned_ns = drive.now_ns - PERIOD_NS
    drive.change_map((15.0, 15.2), (3.0, 5.0))
    while len(drive.published) == 1:
        drive.step()
    assert drive.now_ns - planned_ns == 2_000_000_000
    x = drive.pose.x
    assert x < 10.0
    drive.change_map((x + 3.5, x + 3.7), (0.0, 8.0))
    drive.change_map((x + 3.5, x + 3.7), (6.5, 8.0), 0)
    drive.step()
    assert len(drive.published) == 3, "near ahead: at once"


def test_a_path_that_the_controller_refuses_is_replaced() -> None:
    """What the controller measures differs by millimetres from the map."""
    drive = blocked_before_a_door(other_way=True)
    assert drive.path[:, 1].min() > 3.9
    refuse(drive, 2)
    assert drive.path[:, 1].min() > 3.9, "what is in the way may move"
    paths = []
    for _ in range(10):
        refuse(drive, 1)
        paths.append(drive.path)
    assert min(path[:, 1].min() for path in paths) < 1.5


def test_a_start_from_which_the_controller_refuses_every_path_is_named() -> None:
    drive = blocked_before_a_door(other_way=False)
    refuse(drive, 3)
    assert len(drive.path), "there is no other"
    refuse(drive, 300)
    assert drive.message == Outcome.START_BLOCKED


def test_map_changes_beside_the_path_keep_it() -> None:
    drive = Drive()
    drive.send(9, 4)
    drive.steps(2)
    drive.change_map((5, 6), (6.5, 7.5))  # beside it
    drive.step()
    drive.change_map((1.0, 1.2), (3.9, 4.1))  # behind the robot
    drive.step()
    drive.change_map((5, 6), (6.5, 7.5), 0)  # cheaper, but not on the way
    drive.steps(30)
    assert len(drive.published) == 2, "the path and the stop at its end"


def test_before_the_robot_starts_a_new_map_replans() -> None:
    drive = Drive()
    drive.moving = False
    drive.change_map((4.5, 4.7), (0, 5))
    drive.send(9, 3)
    drive.steps(2)
    assert drive.path[:, 1].max() > 5
    drive.change_map((4.5, 4.7), (2.2, 3.8), 0)
    drive.step()
    assert drive.path[:, 1].max() < 5


def test_before_the_robot_starts_a_search_with_headings_is_not_repeated() -> None:
    drive = Drive(drive="ackermann", min_turning_radius_m=0.8)
    drive.moving = False
    drive.pose = Pose2(5, 4, math.pi)  # a car turns with several moves
    drive.send(9, 4)
    drive.step()
    plans = drive.navigator.planner.plan
    asked: list[Pose2] = []
    drive.navigator.planner.plan = lambda start, *a, **k: (
        asked.append(start) or plans(start, *a, **k)
    )
    drive.change_map((0.4, 0.6), (7, 7.2))  # far from the path
    drive.step()
    assert not asked
    drive.change_map((8, 8.4), (3.5, 4.5))  # on it
    drive.step()
    assert asked


def test_the_robot_does_not_oscillate_between_equal_paths() -> None:
    drive = Drive()
    drive.change_map((4.5, 5.5), (2.5, 5.5))
    drive.send(9, 4)
    drive.step()
    side = np.sign(drive.path[:, 1] - 4)[np.abs(drive.path[:, 1] - 4).argmax()]
    for i in range(6):
        # The way on the other side gets a little better with every map.
        edge = 4 + side * 1.5
        drive.change_map((4.5 + 0.1 * i, 4.6 + 0.1 * i), (4 - side * 1.5, 4), 0)
        drive.change_map((4.5, 5.5), tuple(sorted((edge, edge + side * 0.1))))
        drive.step()
    paths = [p for p in drive.published if len(p)]
    assert all(side * (p[np.abs(p[:, 1] - 4).argmax(), 1] - 4) > 0 for p in paths)


def test_a_much_cheaper_path_replaces_a_valid_one() -> None:
    drive = Drive()
    drive.change_map((4.5, 4.7), (0, 7))
    drive.send(9, 2)
    drive.steps(2)
    assert drive.path[:, 1].max() > 7
    drive.change_map((4.5, 4.7), (1, 4), 0)
    drive.steps(4)
    assert drive.path[:, 1].max() < 5
    assert drive.navigator.report.replans == 1


def test_without_progress_the_planner_replans_and_ends_stuck() -> None:
    drive = Drive(progress_timeout_s=2.0, max_stuck_replans=2)
    drive.moving = False
    drive.send(9, 4)
    drive.steps(6)
    assert drive.navigator.report.replans == 0
    assert len(drive.published) == 2, "the same path is published again"
    drive.steps(6)
    assert drive.message == Outcome.STUCK
    assert drive.navigator.report.result == "stuck"
    assert not len(drive.published[-1])


def test_a_match_near_the_end_of_a_new_path_does_not_count_as_progress() -> None:
    """A robot beside its goal, 0.28 rad off its heading, that does not turn."""
    drive = Drive(progress_timeout_s=2.0, max_stuck_replans=2)
    drive.pose, drive.moving = Pose2(7.96, 3.96, 0.28), False
    drive.send(8, 4, 0.0)
    drive.steps(16)
    assert drive.message == Outcome.STUCK


def test_driving_away_from_the_goal_around_a_wall_is_progress() -> None:
    occupancy, spec = empty_map(10, 8)
    fill(occupancy, spec, (0.2, 5.0), (4.6, 4.8))
    fill(occupancy, spec, (0.2, 5.0), (3.2, 3.4))
    fill(occupancy, spec, (0.2, 0.4), (3.2, 4.8))
    drive = Drive(occupancy, progress_timeout_s=2.0)
    drive.send(1, 6.5)
    drive.steps(60)
    assert drive.message == Phase.REACHED
    assert drive.navigator.report.replans == 0


def test_a_goal_times_out() -> None:
    drive = Drive(goal_timeout_s=2.0)
    drive.send(9, 4)
    drive.steps(3)
    assert drive.message == Phase.FOLLOWING
    drive.steps(3)
    assert drive.message == Outcome.TIMED_OUT


def test_a_closed_path_is_retried_then_fails() -> None:
    drive = Drive(max_stuck_replans=3)
    drive.send(9, 4)
    drive.steps(3)
    drive.change_map((6, 6.2), (0, 8))
    drive.step()
    assert drive.message == Phase.PLANNING
    assert drive.navigator.report.plan == "no_path"
    assert not len(drive.published[-1])
    drive.steps(5)
    assert drive.message == Outcome.NO_PATH
    reopened = Drive(max_stuck_replans=3)
    reopened.send(9, 4)
    reopened.steps(3)
    reopened.change_map((6, 6.2), (0, 8))
    reopened.step()
    reopened.change_map((6, 6.2), (0, 8), 0)
    reopened.steps(30)
    assert reopened.message == Phase.REACHED


def test_a_robot_far_off_its_path_gets_a_new_one() -> None:
    drive = Drive()
    drive.send(9, 4)
    drive.steps(4)
    drive.moving, drive.pose = False, Pose2(drive.pose.x, 5.5, 0)
    drive.step()
    np.testing.assert_allclose(drive.published[-1][0, :2], drive.pose[:2])


def test_new_parameters_replan() -> None:
    drive = Drive()
    drive.send(9, 4)
    drive.step()
    drive.navigator.configure(PlannerParams(path_spacing_m=0.05))
    drive.moving = False
    drive.step()
    assert len(drive.published[-1]) > 1.9 * len(drive.published[0])


def test_progress_is_measured_along_the_path() -> None:
    there_and_back = np.array([[0.0, 0], [5, 0], [5, 0.5], [0, 0.5]])
    progress = PathProgress(headed(resample(there_and_back, 0.1)))
    assert progress.distance_left_m == pytest.approx(10.5)
    progress.update(Pose2(0.4, 0.2, 0))
    assert progress.distance_left_m == pytest.approx(10.1, abs=0.11)
    for x in np.arange(0.5, 4.6, 0.5):
        progress.update(Pose2(float(x), 0.1, 0))
    assert progress.distance_left_m == pytest.approx(6.0, abs=0.2)
    progress.update(Pose2(3.5, 0.1, 0))
    assert progress.distance_left_m == pytest.approx(6.0, abs=0.2), "never back"


def test_turning_in_place_is_progress() -> None:
    path = joined(
        turn_in_place(0, 0, math.pi, 0),
        headed(np.array([[0.0, 0], [0.1, 0], [0.2, 0]])),
    )
    progress = PathProgress(path)
    covered = []
    for yaw in (3.1, 2.5, 1.5, 0.5, 0.0):
        progress.update(Pose2(0, 0, yaw))
        covered.append(progress.covered)
    assert covered == sorted(set(covered))
