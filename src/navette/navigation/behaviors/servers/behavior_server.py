"""Server of one behavior action."""

from typing import Any, Protocol

from navette.navigation.behaviors.params import BehaviorParams
from navette.navigation.behaviors.runner import (
    STOP,
    Behavior,
    BehaviorEnd,
    BehaviorInputs,
    Command,
)
from navette.navigation.behaviors.servers.actions import BehaviorAction
from navette.navigation.grids import CollisionCheck
from navette.runtime.node import Node
from navette.runtime.stage.goal_server import (
    Activation,
    DriveGoalServer,
    GoalEnd,
    GoalStepper,
    goal_end,
)
from navette.runtime.time import Duration


class BehaviorHost(Protocol):
    """The node of the servers."""

    @property
    def params(self) -> BehaviorParams:
        """The present parameters."""

    @property
    def collision(self) -> CollisionCheck:
        """The collision check with the newest obstacles."""

    def begin(self, server: "BehaviorServer") -> None:
        """Make the new goal of a server the only one, before it is stepped."""


class BehaviorServer(GoalStepper):
    """Runs the behavior of the active goal; the node calls :meth:`step`."""

    def __init__(
        self,
        node: Node,
        spec: BehaviorAction,
        *,
        host: BehaviorHost,
        activation: Activation,
    ) -> None:
        self.spec = spec
        #: The behavior of the newest goal; None if the goal was refused.
        self.behavior: Behavior | None = None
        self._node = node
        self._host = host
        self._start_ns = 0
        self._goals = DriveGoalServer(
            node, spec.action, spec.name, owner=self, activation=activation
        )

    @property
    def is_active(self) -> bool:
        return self._goals.is_active

    def step(
        self, inputs: BehaviorInputs, dt: float, *, paused: bool
    ) -> Command | None:
        """Step the goal and return the command to publish, if any.

        Args:
            inputs: motion of the robot, and whether obstacles are known.
            dt: seconds since the last step.
            paused: whether the commands are masked: time does not count then.
        """
        command: Command | None = STOP
        if not self._goals.is_ending and self.behavior is not None:
            command = self._step(self.behavior, inputs, dt, paused=paused)
        motion = inputs.motion
        measured = None if motion is None else (motion.speed, motion.turn_rate)
        self._goals.check_rest(measured, self._now_ns)
        return command

    def stop(self, reason: str) -> None:
        """End the goal because of something else; the result follows at rest."""
        self._end(BehaviorEnd("UNKNOWN", reason))

    def abort(self, reason: str) -> None:
        """End the goal at once."""
        self._goals.abort(self._result(BehaviorEnd("UNKNOWN", reason)))

    def _step(
        self, behavior: Behavior, inputs: BehaviorInputs, dt: float, *, paused: bool
    ) -> Command | None:
        if self._goals.cancel_requested:
            self._end(BehaviorEnd("NONE", "cancelled"))
            return STOP
        if paused:
            return STOP
        step = behavior.step(inputs, dt)
        self._goals.publish_feedback(**self.spec.feedback(behavior.progress))
        if step.end is not None:
            self._end(step.end)
        return step.command

    def on_goal(self, request: Any) -> None:
        self._start_ns = self._now_ns
        host = self._host
        host.begin(self)
        made = self.spec.behavior(request, host.params, host.collision)
        if isinstance(made, BehaviorEnd):
            self.behavior = None
            self._end(made)
        else:
            self.behavior = made

    def _end(self, end: BehaviorEnd) -> None:
        if end.code != "NONE":
            text = f"{self.spec.name}: {end.code}: {end.reason}"
            self._node.get_logger().warning(text)
        if self.spec.output:
            has_moved = self.behavior is not None
            self._goals.end_at_rest(
                self._result(end), self._now_ns, has_moved=has_moved
            )
        else:
            self._goals.end(self._result(end))

    def _result(self, end: BehaviorEnd) -> GoalEnd:
        elapsed = Duration(nanoseconds=max(0, self._now_ns - self._start_ns))
        return goal_end(
            self.spec.action, end.code, end.reason, total_elapsed_time=elapsed.to_msg()
        )

    @property
    def _now_ns(self) -> int:
        return self._node.get_clock().now().nanoseconds
