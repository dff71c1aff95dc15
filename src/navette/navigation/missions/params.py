"""Parameters of the missions stage."""

import math
import re
from dataclasses import dataclass
from pathlib import Path

from navette.errors import ParameterError
from navette.navigation.shared_params import FrameParams
from navette.params import param

TREES = Path(__file__).parent / "trees"


def tree_path(name: str) -> Path:
    """Return the file of a behaviour tree: one of Navette's by its name, or a path."""
    own = TREES / f"{name}.xml"
    # A longer name is an error of the file system.
    return own if re.fullmatch(r"\w{1,64}", name) and own.is_file() else Path(name)


@dataclass(frozen=True, kw_only=True)
class MissionParams(FrameParams):
    """Goals, timeout and failure rule."""

    goals_m: tuple[float, ...] = param((), "initial goals: x1, y1, …")
    goal_timeout_s: float = param(
        300.0, "time after which a goal fails (timed_out); 0: no limit", at_least=0.0
    )
    on_failure: str = param(
        "continue", "what to do after a failed goal", choices=("continue", "stop")
    )
    wait_for_map: bool = param(True, "send the first goal after a map has arrived")
    rate_hz: float = param(
        10.0,
        "rate of checks and of ticking the behaviour tree",
        at_least=1.0,
        at_most=1000.0,
    )
    default_nav_to_pose_bt_xml: str = param(
        "", "behaviour tree of navigate_to_pose: a file, or precise; empty: Navette's"
    )
    default_nav_through_poses_bt_xml: str = param(
        "", "file of the behaviour tree of navigate_through_poses; empty: Navette's"
    )
    error_code_names: tuple[str, ...] = param(
        ("navigate_error_code", "compute_path_error_code", "follow_path_error_code"),
        "blackboard entries with error codes; the lowest becomes the action's",
    )
    stop_on_failure: bool = param(
        False, "whether follow_waypoints ends with the first missed waypoint"
    )

    def check(self) -> None:
        if len(self.goals_m) % 2:
            raise ParameterError(
                f"parameter 'goals_m': {len(self.goals_m)} numbers; expected pairs x, y"
            )
        if not all(map(math.isfinite, self.goals_m)):
            raise ParameterError(
                f"parameter 'goals_m': {self.goals_m}; expected finite numbers"
            )

    def goal_points(self) -> list[tuple[float, float]]:
        """Return the goals as points (x, y), metres."""
        return list(zip(self.goals_m[0::2], self.goals_m[1::2], strict=True))

    @property
    def to_pose_tree(self) -> Path:
        """File of the behaviour tree of navigate_to_pose."""
        return tree_path(self.default_nav_to_pose_bt_xml or "navigate")

    @property
    def through_poses_tree(self) -> Path:
        """File of the behaviour tree of navigate_through_poses."""
        return tree_path(self.default_nav_through_poses_bt_xml or "navigate_through")
