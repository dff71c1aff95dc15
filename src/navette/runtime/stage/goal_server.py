"""Action server of a stage with one active goal, as Nav2's SimpleActionServer."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any, NamedTuple, Protocol

from navette.msgs.known_fields import made
from navette.runtime.action.goal_states import CancelResponse, GoalEvent, GoalResponse
from navette.runtime.action.server import ActionServer
from navette.runtime.action.server_goal_handle import ServerGoalHandle
from navette.runtime.node import Node

PREEMPTED = "preempted by a new goal"

# Measured motion that counts as rest, and the longest wait for it: a robot whose
# odometry reports motion although it is commanded zero must not block its client.
_REST_MPS, _REST_RADPS = 0.03, 0.05
_LONGEST_STOP_NS = 2_000_000_000
# A robot that has just been commanded to move may still be measured at rest.
_SETTLE_NS = 200_000_000


class GoalEnd(NamedTuple):
    """How a goal ends: its result, and whether it is aborted."""

    result: Any
    failed: bool = False


def goal_end(
    action: Any, code: str = "NONE", reason: str = "", **fields: Any
) -> GoalEnd:
    """Return the end of a goal, with a result as the chosen distribution defines it.

    Args:
        action: the action's type. Results have no ``error_code`` before Jazzy.
        code: name of Nav2's error code; ``NONE`` on success.
        reason: text of the error.
        fields: other fields of the result.
    """
    result_type = action.Result
    number = getattr(result_type, code, 0)
    result = made(result_type, error_code=number, error_msg=reason, **fields)
    return GoalEnd(result, failed=code != "NONE")


class Activation(Protocol):
    """State of the owner of action servers: only an active one accepts goals."""

    @property
    def is_active(self) -> bool: ...


def response_of(activation: Activation) -> GoalResponse:
    """Accept a goal if the owner is active."""
    return GoalResponse.ACCEPT if activation.is_active else GoalResponse.REJECT


class GoalStepper(ABC):
    """Steps the goals of a :class:`GoalServer`."""

    @abstractmethod
    def on_goal(self, request: Any) -> None:
        """Begin an accepted goal."""

    def on_cancel(self) -> None:  # noqa: B027 - most owners poll cancel_requested
        """Process a client's request to cancel the active goal."""


class GoalServer:
    """Action server whose owner steps the goal; a new goal preempts the active one.

    The preempted goal is aborted. Its result has ``error_msg`` set and no error code,
    as in Nav2. The owner ends the goal with :meth:`finish` or :meth:`cancel`, also from
    within ``on_goal``.

    Args:
        node: the node that offers the action.
        action: the action's type.
        name: the action's name.
        owner: steps the goals.
        activation: whether goals are accepted now.
    """

    def __init__(
        self,
        node: Node,
        action: Any,
        name: str,
        *,
        owner: GoalStepper,
        activation: Activation,
    ) -> None:
        self._call_soon = node.context.loop.call_soon
        self._action = action
        self._owner = owner
        self._goal: ServerGoalHandle | None = None
        self._server = ActionServer(
            node,
            action,
            name,
            lambda goal: None,  # goals are stepped by the owner instead
            goal_callback=lambda goal: response_of(activation),
            handle_accepted_callback=self._accept,
            cancel_callback=self._accept_cancel,
        )

    @property
    def goal(self) -> ServerGoalHandle | None:
        """The active goal."""
        return self._goal

    @property
    def is_active(self) -> bool:
        """Whether a goal is active."""
        return self._goal is not None

    @property
    def cancel_requested(self) -> bool:
        """Whether the client requested that the active goal is cancelled."""
        return self._goal is not None and self._goal.is_cancel_requested

    def publish_feedback(self, **fields: Any) -> None:
        """Publish feedback on the active goal."""
        if self._goal is not None:
            self._goal.publish_feedback(made(self._action.Feedback, **fields))

    def finish(self, end: GoalEnd) -> None:
        """End the goal: aborted if it failed, otherwise succeeded."""
        goal = self._take()
        if goal is not None:
            report = goal.abort if end.failed else goal.succeed
            report(end.result)

    def abort(self, end: GoalEnd) -> None:
        """End the goal as aborted."""
        goal = self._take()
        if goal is not None:
            goal.abort(end.result)

    def cancel(self, end: GoalEnd) -> None:
        """End the goal as cancelled on the client's request."""
        goal = self._take()
        if goal is not None:
            goal.canceled(end.result)

    def end(self, end: GoalEnd) -> None:
        """End the goal: cancelled if requested, otherwise as :meth:`finish`."""
        if self.cancel_requested:
            self.cancel(end)
        else:
            self.finish(end)

    def _take(self) -> ServerGoalHandle | None:
        goal, self._goal = self._goal, None
        return goal

    def _accept(self, goal: ServerGoalHandle) -> None:
        self.abort(goal_end(self._action, reason=PREEMPTED))
        if not goal.is_cancel_requested:
            goal.update_state(GoalEvent.EXECUTE)
        self._goal = goal
        self._owner.on_goal(goal.request)

    def _accept_cancel(self, goal: ServerGoalHandle) -> CancelResponse:
        self._call_soon(self._owner.on_cancel, "cancel")
        return CancelResponse.ACCEPT


class DriveGoalServer(GoalServer):
    """Action server of goals that drive: the result follows when the robot is at rest.

    The owner commands zero velocity while :attr:`is_ending` and calls
    :meth:`check_rest` at every step. A new goal ends the old one at once.
    """

    _ending: Callable[[], None] | None = None
    _settled_ns = _deadline_ns = 0

    @property
    def is_ending(self) -> bool:
        """Whether the goal has a result and the robot is not known to be at rest."""
        return self._ending is not None

    def end_at_rest(self, end: GoalEnd, now_ns: int, *, has_moved: bool = True) -> None:
        """Store the end, to :meth:`end` the goal with when the robot is at rest.

        Args:
            end: the result, and whether the goal failed.
            now_ns: time of the node's clock.
            has_moved: whether the goal has commanded motion.
        """
        if self._goal is None or self._ending is not None:
            return
        self._ending = lambda: self.end(end)
        self._settled_ns = now_ns + _SETTLE_NS if has_moved else now_ns
        self._deadline_ns = now_ns + _LONGEST_STOP_NS

    def check_rest(self, motion: tuple[float, float] | None, now_ns: int) -> None:
        """Publish the stored result once the robot is at rest.

        Args:
            motion: measured speed (m/s) and turn rate (rad/s); None without recent
                odometry. The result is then published after two seconds.
            now_ns: time of the node's clock.
        """
        if self._ending is None:
            return
        resting = (
            motion is not None
            and abs(motion[0]) <= _REST_MPS
            and abs(motion[1]) <= _REST_RADPS
        )
        settled = resting and now_ns >= self._settled_ns
        if settled or not 0 <= self._deadline_ns - now_ns <= _LONGEST_STOP_NS:
            self._ending()

    def _take(self) -> ServerGoalHandle | None:
        self._ending = None
        return super()._take()

    def _accept(self, goal: ServerGoalHandle) -> None:
        if self._ending is not None:
            self._ending()
        super()._accept(goal)
