"""Interface of the node ``control`` to its servers and reports."""

from typing import Protocol

from navette.geometry import Pose2
from navette.navigation.control.explanations import Situation
from navette.navigation.control.params import ControlParams
from navette.runtime.stage.path_messages import Poses


class ControlHost(Protocol):
    """The node that drives the follower."""

    @property
    def params(self) -> ControlParams:
        """The present parameters."""

    def frame_on_map(self, frame_id: str) -> Pose2 | None:
        """Return the pose of a frame in the map frame; None if unknown."""

    def follow_goal(self, poses: Poses, method: str) -> None:
        """Follow the path of a goal.

        Args:
            poses: (N, 3), map.
            method: steering method; empty: the configured one.

        Raises:
            InvalidValueError: the poses are not a path.
        """

    def stop_goal(self) -> bool:
        """Stop if the path is that of a goal; return whether it was."""

    def situation(self) -> Situation:
        """Return what an explanation of a stop requires."""
