"""Navigation to a goal or through goals by a behaviour tree, from start to end.

A new goal replaces the one under way: with the same tree, tree and robot continue; with
another tree, the old one is halted first. A cancelled navigation ends when the robot is
at rest.
"""

import math
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol

from py_trees.common import Status

from navette.errors import FileFormatError
from navette.files.untrusted.files import open_regular
from navette.geometry import Pose2
from navette.msgs.geometry_msgs.msg import PoseStamped
from navette.navigation.missions.sequence import (
    CANCELED,
    FAILED,
    PREEMPTED,
    REACHED,
)
from navette.navigation.missions.tree.behaviour import FAILURE, SUCCESS
from navette.navigation.missions.tree.own_nodes import ERROR_CODES
from navette.navigation.missions.tree.paths import nearest_index, path_length_m
from navette.navigation.missions.tree.robot_access import RobotAccess
from navette.navigation.missions.tree.tree_file import TreeFile
from navette.navigation.missions.tree_run import StatusChange, TreeRun

PREEMPTED_TEXT = "preempted by a newer goal"
# A robot that does not stop within this time has another problem.
_REST_TIMEOUT_NS = 5_000_000_000
# The pose of a robot that has just started is known a moment later.
_POSE_TIMEOUT_NS = 2_000_000_000
_LEAST_SPEED_MPS = 0.05
_NAMES = {code: word for word, code in ERROR_CODES.items()}
_NAMES[208], _NAMES[308] = "no_path", "no_path"


class RestingRobot(RobotAccess, Protocol):
    """A robot that reports whether it stands."""

    @property
    def is_at_rest(self) -> bool: ...


@dataclass(frozen=True)
class NavigationEnd:
    """How a navigation ended.

    Attributes:
        how: ``reached``, ``canceled``, ``preempted`` or the name of the failure.
        error_code: Nav2's; 0 on success.
        text: explanation for people.
    """

    how: str
    error_code: int = 0
    text: str = ""


@dataclass(frozen=True)
class NavigationProgress:
    """Values of the actions' feedback."""

    pose: Pose2 | None
    time_s: float
    time_left_s: float
    recoveries: int
    distance_left_m: float
    goals_left: int


OnNavigationEnd = Callable[[NavigationEnd], None]
"""Called once, with how the navigation ended."""


@dataclass
class Navigation:
    """A goal, or goals to drive through, under way.

    Attributes:
        goals: one for ``navigate_to_pose``.
        tree: file of the behaviour tree.
        through: whether all goals are on the blackboard as ``goals``.
    """

    goals: Sequence[PoseStamped]
    tree: Path
    on_end: OnNavigationEnd = field(kw_only=True)
    through: bool = False
    started_ns: int = 0


class TreeNavigator:
    """Runs the tree of one navigation at a time.

    Args:
        robot: where the tree's leaves act.
        error_names: blackboard entries that hold error codes.
    """

    def __init__(self, robot: RestingRobot, error_names: Sequence[str]) -> None:
        self._robot = robot
        self._error_names = tuple(error_names)
        self._files: dict[tuple[Path, int], TreeFile] = {}
        self.run: TreeRun | None = None
        self.active: Navigation | None = None
        self._cancelled_ns: int | None = None
        self._first_ns: int | None = None

    def load(self, path: Path) -> TreeFile:
        """Read a tree's file; a changed file is read again.

        Raises:
            FileFormatError: the file or its tree is invalid.
        """
        try:
            # A client names the file: a pipe would block the node.
            with open_regular(path) as opened:
                key = path, os.fstat(opened.fileno()).st_mtime_ns
        except ValueError as error:  # a null character
            if isinstance(error, FileFormatError):
                raise
            raise FileFormatError(repr(str(path)), str(error)) from None
        if key not in self._files:
            file = TreeFile.read(path)
            TreeRun(file, self._robot)
            self._files[key] = file
        return self._files[key]

    def start(self, navigation: Navigation) -> None:
        """Start a navigation; one that is under way ends as preempted.

        Raises:
            FileFormatError: its tree cannot be loaded; the one under way continues.
        """
        file = self.load(navigation.tree)
        before, run = self.active, self.run
        continues = (
            before is not None
            and run is not None
            and run.is_running
            and run.file is file
            and self._cancelled_ns is None
            and before.through == navigation.through
        )
        if not continues:
            if run is not None and run.is_running:
                run.halt()
            run = self.run = TreeRun(file, self._robot)
        assert run is not None, "made above"
        navigation.started_ns = self._robot.now_ns
        self.active, self._cancelled_ns = navigation, None
        run.set_entries(self._entries(navigation))
        if before is not None:
            before.on_end(NavigationEnd(PREEMPTED, 0, PREEMPTED_TEXT))

    def cancel(self) -> None:
        """Halt the tree; the navigation ends when the robot is at rest."""
        if self.active is None or self._cancelled_ns is not None:
            return
        self._cancelled_ns = self._robot.now_ns
        if self.run is not None:
            self.run.halt()

    def step(self) -> None:
        """Tick the tree; report the end of the navigation."""
        active, run = self.active, self.run
        if active is None or run is None:
            return
        if self._cancelled_ns is not None:
            waited_ns = self._robot.now_ns - self._cancelled_ns
            if self._robot.is_at_rest or waited_ns >= _REST_TIMEOUT_NS:
                self._end(NavigationEnd(CANCELED))
            return
        if not run.is_running and self._waits_for_pose(active):
            return
        status = run.tick()
        if status in (SUCCESS, FAILURE):
            self._end(self._outcome(run, status))

    def _waits_for_pose(self, active: Navigation) -> bool:
        """Whether the first tick waits: most nodes fail while the pose is unknown."""
        if self._first_ns is None:
            self._first_ns = active.started_ns
        waited_ns = self._robot.now_ns - self._first_ns
        return self._robot.pose() is None and waited_ns < _POSE_TIMEOUT_NS

    def progress(self) -> NavigationProgress:
        """Return the values of the feedback."""
        active, run = self.active, self.run
        assert active is not None, "a navigation is under way"
        assert run is not None, "a navigation runs a tree"
        left = self._distance_left(active, run)
        speed = max(abs(self._robot.velocity()[0]), _LEAST_SPEED_MPS)
        goals = run.blackboard.get("goals") if active.through else None
        return NavigationProgress(
            pose=self._robot.pose(),
            time_s=(self._robot.now_ns - active.started_ns) / 1e9,
            time_left_s=left / speed,
            recoveries=run.blackboard.get("number_recoveries", 0),
            distance_left_m=left,
            goals_left=len(goals) if goals is not None else 0,
        )

    def take_changes(self) -> list[StatusChange]:
        return [] if self.run is None else self.run.take_changes()

    def _entries(self, navigation: Navigation) -> dict[str, Any]:
        entries: dict[str, Any] = {
            "number_recoveries": 0,
            "initial_pose_received": self._robot.pose() is not None,
            "failure": "",
            "navigate_error_msg": "",
            **dict.fromkeys(self._error_names, 0),
        }
        if navigation.through:
            entries["goals"] = list(navigation.goals)
        entries["goal"] = navigation.goals[-1]
        return entries

    def _outcome(self, run: TreeRun, status: Status) -> NavigationEnd:
        if status is SUCCESS:
            return NavigationEnd(REACHED)
        board = run.blackboard
        codes = [board.get(name, 0) for name in self._error_names]
        code = min((code for code in codes if code), default=0)
        failure = board.get("failure") or _NAMES.get(code, FAILED)
        text = board.get("navigate_error_msg") or _reason(run) or failure
        return NavigationEnd(failure, code, text)

    def _end(self, end: NavigationEnd) -> None:
        active, self.active = self.active, None
        self._cancelled_ns = None
        if active is not None:
            active.on_end(end)

    def _distance_left(self, active: Navigation, run: TreeRun) -> float:
        pose, path = self._robot.pose(), run.blackboard.get("path")
        if pose is None:
            return 0.0
        goal = active.goals[-1].pose.position
        straight = math.dist((pose.x, pose.y), (goal.x, goal.y))
        if path is None or not path.poses:
            return straight
        return path_length_m(path, nearest_index(path, pose.x, pose.y))


def _reason(run: TreeRun) -> str:
    """Return the message of the last node that failed with one."""
    failed = [n for n in run.nodes if n.status is FAILURE and n.feedback_message]
    return f"{failed[-1].name}: {failed[-1].feedback_message}" if failed else ""
