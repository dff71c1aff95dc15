"""Decorators: BehaviorTree.CPP's, and Nav2's rates, triggers and goal updates."""

from abc import abstractmethod
from collections.abc import Iterator
from typing import Any, ClassVar

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.decorators import Decorator

from navette.geometry import Pose2
from navette.navigation.missions.tree.behaviour import (
    FAILURE,
    IDLE,
    RUNNING,
    SUCCESS,
    NodeSetup,
    Ports,
    TreeNode,
)
from navette.navigation.missions.tree.controls import Ticks, halt
from navette.navigation.missions.tree.paths import (
    distance_of,
    path_length_m,
    without_passed,
)
from navette.navigation.missions.tree.ports import (
    Port,
    entry_of,
    output_port,
    parse_count,
    parse_float,
    parse_int,
    parse_message,
)


class DecoratorNode(TreeNode, Decorator):
    """A node with one child; :meth:`run` ticks it and returns the status."""

    def __init__(self, setup: NodeSetup) -> None:
        Decorator.__init__(self, setup.name, setup.children[0])
        self.equip(setup)

    def begin(self) -> None:
        """Override to reset the state that a run keeps."""

    @abstractmethod
    def run(self) -> Ticks:
        """Tick the child and return the status of this node."""

    def update(self) -> Status:
        return self.decorated.status

    def tick(self) -> Iterator[Behaviour]:
        if self.status is IDLE:
            self.begin()
        status = yield from self.run()
        if status is not RUNNING:
            self.stop(status)
        self.status = status
        yield self

    def tick_child(self) -> Ticks:
        """Tick the child; one that has ended starts from idle."""
        if self.decorated.status is not RUNNING:
            halt(self.decorated)
        yield from self.decorated.tick()
        return self.decorated.status


class MappedStatusNode(DecoratorNode):
    """Replace the child's final status."""

    ON_SUCCESS: ClassVar[Status] = SUCCESS
    ON_FAILURE: ClassVar[Status] = FAILURE

    def run(self) -> Ticks:
        status = yield from self.tick_child()
        if status is RUNNING:
            return RUNNING
        return self.ON_SUCCESS if status is SUCCESS else self.ON_FAILURE


class InverterNode(MappedStatusNode):
    """Swap success and failure."""

    ON_SUCCESS, ON_FAILURE = FAILURE, SUCCESS


class ForceSuccessNode(MappedStatusNode):
    """Succeed when the child ends."""

    ON_FAILURE = SUCCESS


class ForceFailureNode(MappedStatusNode):
    """Fail when the child ends."""

    ON_SUCCESS = FAILURE


class KeepRunningUntilFailureNode(MappedStatusNode):
    """Tick the child again and again until it fails."""

    ON_SUCCESS = RUNNING


class CountedNode(DecoratorNode):
    """Count ends of the child."""

    PORTS: ClassVar[Ports] = {}
    CONTINUES_ON: ClassVar[Status] = SUCCESS

    def begin(self) -> None:
        self._count = 0

    def run(self) -> Ticks:
        if self.status is not RUNNING:
            self._count = 0
        (port,) = self.PORTS
        limit = self.input(port)
        if limit == 0:
            return self.CONTINUES_ON
        status = yield from self.tick_child()
        if status is not self.CONTINUES_ON:
            return status
        self._count += 1
        self.feedback_message = f"{self._count}" + (f" of {limit}" if limit > 0 else "")
        # One run of the child in a tick: children that end at once do not block.
        return status if 0 < limit <= self._count else RUNNING


class RepeatNode(CountedNode):
    """Repeat the child while it succeeds, a number of times; -1: without limit."""

    PORTS: ClassVar[Ports] = {"num_cycles": Port(parse_count, required=True)}


class RetryUntilSuccessfulNode(CountedNode):
    """Repeat the child until it succeeds, a number of times; -1: without limit."""

    PORTS: ClassVar[Ports] = {"num_attempts": Port(parse_count, required=True)}
    CONTINUES_ON = FAILURE


class TimeoutNode(DecoratorNode):
    """Fail and halt the child if it runs for too long."""

    PORTS: ClassVar[Ports] = {"msec": Port(parse_int, required=True)}

    def run(self) -> Ticks:
        if self.status is not RUNNING:
            self._start_ns = self.robot.now_ns
        status = yield from self.tick_child()
        if status is not RUNNING:
            return status
        late = self.seconds_since(self._start_ns) * 1000 >= self.input("msec")
        return FAILURE if late else RUNNING


class DelayNode(DecoratorNode):
    """Start the child after a time."""

    PORTS: ClassVar[Ports] = {"delay_msec": Port(parse_int, required=True)}

    def run(self) -> Ticks:
        if self.status is not RUNNING:
            self._start_ns = self.robot.now_ns
        if self.seconds_since(self._start_ns) * 1000 < self.input("delay_msec"):
            return RUNNING
        return (yield from self.tick_child())


class RunOnceNode(DecoratorNode):
    """Tick the child to its end once; then return that status."""

    _ended: Status | None = None

    def run(self) -> Ticks:
        if self._ended is None:
            status = yield from self.tick_child()
            if status is RUNNING:
                return RUNNING
            self._ended = status
        return self._ended


class SubTreeNode(DecoratorNode):
    """The root of another tree of the file, with its own blackboard."""

    def run(self) -> Ticks:
        return (yield from self.tick_child())


class PacedNode(DecoratorNode):
    """Tick the child first and whenever it is due; once running, to its end.

    Nav2's controllers: between two runs the status is running.
    """

    def begin(self) -> None:
        self._first = True

    @abstractmethod
    def due(self) -> bool:
        """Whether the child starts again."""

    def started_again(self) -> None:
        """Override to note that the child ended with success."""

    def run(self) -> Ticks:
        is_due = self.due()
        if not (self._first or self.decorated.status is RUNNING or is_due):
            return RUNNING
        self._first = False
        status = yield from self.tick_child()
        if status is SUCCESS:
            self.started_again()
        return status


class RateControllerNode(PacedNode):
    """Nav2: start the child at a rate."""

    PORTS: ClassVar[Ports] = {"hz": Port(parse_float, "10.0")}

    def begin(self) -> None:
        super().begin()
        self._start_ns = self.robot.now_ns

    def due(self) -> bool:
        hz: float = self.input("hz")
        return self.seconds_since(self._start_ns) * hz >= 1.0

    def started_again(self) -> None:
        self._start_ns = self.robot.now_ns


class DistanceControllerNode(PacedNode):
    """Nav2: start the child each time the robot has moved by a distance."""

    PORTS: ClassVar[Ports] = {
        "distance": Port(parse_float, "1.0"),
        "global_frame": Port(),
        "robot_base_frame": Port(),
    }

    def begin(self) -> None:
        super().begin()
        self._from = self.robot.pose()

    def due(self) -> bool:
        distance: float = self.input("distance")
        return moved_m(self._from, self.robot.pose()) >= distance

    def started_again(self) -> None:
        self._from = self.robot.pose()

    def run(self) -> Ticks:
        if self.robot.pose() is None:
            return FAILURE
        return (yield from super().run())


class GoalWatch:
    """Detects changes of the blackboard's ``goal`` and ``goals``."""

    PORTS: ClassVar[Ports] = {
        "goal": Port(parse_message, entry="goal"),
        "goals": Port(parse_message, entry="goals"),
    }

    def __init__(self, node: TreeNode) -> None:
        self._node = node
        self._seen = self._now()

    def changed(self) -> bool:
        """Whether they changed since the last call or the start."""
        before, self._seen = self._seen, self._now()
        return bool(before != self._seen)

    def _now(self) -> tuple[Any, Any]:
        return self._node.input("goal"), self._node.input("goals")


class SpeedControllerNode(PacedNode):
    """Nav2: start the child at a rate that grows with the robot's speed."""

    PORTS: ClassVar[Ports] = {
        "min_rate": Port(parse_float, "0.1"),
        "max_rate": Port(parse_float, "1.0"),
        "min_speed": Port(parse_float, "0.0"),
        "max_speed": Port(parse_float, "0.5"),
        **GoalWatch.PORTS,
    }

    _start_ns: int
    _period_s: float

    def begin(self) -> None:
        super().begin()
        self._goals = GoalWatch(self)
        self._restart()

    def due(self) -> bool:
        if self._goals.changed():
            self._first = True
            self._restart()
        if self.seconds_since(self._start_ns) < self._period_s:
            return False
        low, high = self.input("min_rate"), self.input("max_rate")
        slow, fast = self.input("min_speed"), self.input("max_speed")
        speed = abs(self.robot.velocity()[0])
        share = min(max((speed - slow) / (fast - slow), 0.0), 1.0) if fast > slow else 1
        self._period_s = 1.0 / max(low + share * (high - low), 1e-6)
        self._start_ns = self.robot.now_ns
        return True

    def _restart(self) -> None:
        self._period_s = 1.0 / max(self.input("max_rate"), 1e-6)
        self._start_ns = self.robot.now_ns


class GoalUpdatedControllerNode(PacedNode):
    """Nav2: start the child when the goal has changed."""

    PORTS: ClassVar[Ports] = GoalWatch.PORTS

    def begin(self) -> None:
        super().begin()
        self._goals = GoalWatch(self)

    def due(self) -> bool:
        return self._goals.changed()


class SingleTriggerNode(DecoratorNode):
    """Nav2: tick the child to its end once; then fail."""

    def begin(self) -> None:
        self._ended = False

    def run(self) -> Ticks:
        if self._ended:
            return FAILURE
        status = yield from self.tick_child()
        self._ended = status is not RUNNING
        return status


class GoalUpdaterNode(DecoratorNode):
    """Nav2: replace the goal, or the goals, by newer ones from a topic."""

    PORTS: ClassVar[Ports] = {
        "input_goal": Port(parse_message),
        "output_goal": output_port(),
        "goal_updater_topic": Port(default="goal_update"),
        "input_goals": Port(parse_message),
        "output_goals": output_port(),
        "goals_updater_topic": Port(default="goals_update"),
    }

    def run(self) -> Ticks:
        self.output("output_goal", self._newest_goal())
        goals = self.input("input_goals")
        if goals:
            self.output("output_goals", self._newest_goals(goals))
        return (yield from self.tick_child())

    def _newest_goal(self) -> Any:
        goal = self.input("input_goal")
        newest = self.robot.newest(
            self.input("goal_updater_topic"), "geometry_msgs/msg/PoseStamped"
        )
        if newest is not None and goal is not None and _stamp(newest) > _stamp(goal):
            return newest
        return goal

    def _newest_goals(self, goals: Any) -> Any:
        newest = self.robot.newest(
            self.input("goals_updater_topic"), "nav_msgs/msg/Goals"
        )
        if newest is None or not newest.goals or _stamp(newest) <= _stamp(goals[0]):
            return goals
        return list(newest.goals)


class ForEachGoalNode(DecoratorNode):
    """Navette: run the child for one goal after another.

    A goal counts as passed within a radius, so that the robot drives on without
    stopping; the last one counts when the child succeeds.
    """

    PORTS: ClassVar[Ports] = {
        "goals": Port(parse_message, required=True),
        "goal": output_port(),
        "radius": Port(parse_float, "0.7"),
    }

    def run(self) -> Ticks:
        goals, pose = self.input("goals"), self.robot.pose()
        if not goals:
            return SUCCESS
        if pose is not None:
            goals = without_passed(goals, pose, self.input("radius"))
        self._set(goals)
        status = yield from self.tick_child()
        if status is not SUCCESS:
            return status
        self._set(goals[1:])
        return RUNNING if goals[1:] else SUCCESS

    def _set(self, goals: list[Any]) -> None:
        self.blackboard.set(entry_of(self._attributes["goals"]) or "goals", goals)
        self.feedback_message = f"{len(goals)} left"
        if goals:
            self.output("goal", goals[0])


class PathLongerOnApproachNode(DecoratorNode):
    """Nav2: tick the child if a new path near the goal is much longer."""

    PORTS: ClassVar[Ports] = {
        "path": Port(parse_message, required=True),
        "prox_len": Port(parse_float, "3.0"),
        "length_factor": Port(parse_float, "2.0"),
    }
    _old: Any = None

    def run(self) -> Ticks:
        if self.decorated.status is RUNNING or self._is_longer():
            status = yield from self.tick_child()
            if status is RUNNING:
                return RUNNING
            self._old = self.input("path")
            return status
        self._old = self.input("path")
        return SUCCESS

    def _is_longer(self) -> bool:
        old, new = self._old, self.input("path")
        if old is None or new is None or not old.poses or not new.poses:
            return False
        before, now = path_length_m(old), path_length_m(new)
        near: float = self.input("prox_len")
        factor: float = self.input("length_factor")
        same_end = old.poses[-1].pose == new.poses[-1].pose
        updated = same_end and new.poses != old.poses
        return bool(updated) and before < near and now > factor * before


def moved_m(start: Pose2 | None, now: Pose2 | None) -> float:
    """Return the distance between two poses; 0 if one is unknown."""
    return 0.0 if start is None or now is None else distance_of(start, now)


def _stamp(msg: Any) -> tuple[int, int]:
    return msg.header.stamp.sec, msg.header.stamp.nanosec
