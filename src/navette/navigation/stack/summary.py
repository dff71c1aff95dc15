"""Summary of a run, as printed by ``--json``."""

import json
import math
from dataclasses import asdict, dataclass

from navette.navigation.missions import GoalOutcome
from navette.navigation.planning.params import PlannerParams


@dataclass(frozen=True)
class PoseError:
    """Distance of the estimated from the true position, m.

    Both positions are in the world's frame. In a run on a map that does not fit the
    world they are in different frames, and the error is not defined.

    Attributes:
        worst: largest so far, while the robot counted as localized; None: it never did.
        final: at the end; None without an estimate.
        map_fits_world: whether the map on which the robot locates itself is in the
            world's frame; None: it does so without a given map, or none came.
    """

    worst: float | None
    final: float | None
    map_fits_world: bool | None = None


@dataclass(frozen=True)
class RunSummary:
    """Summary of a run; ``min_clearance_m`` is from the body to the nearest obstacle.

    Seconds are simulated unless named otherwise. Goals are judged by the estimated
    pose; ``pose_error_m`` is its distance from the true one. ``true_goal_distance_m``
    is the largest true distance from a goal when it counted as reached (None: unknown),
    ``goal_tolerance_m`` the one that counts as reached.
    """

    goals: tuple[GoalOutcome, ...]
    contacts: int
    min_clearance_m: float | None
    sim_time_s: float
    wall_time_s: float
    real_time_factor: float
    seed: int
    pose_error_m: PoseError
    true_goal_distance_m: float | None = None
    goal_tolerance_m: float = PlannerParams().goal_tolerance_m

    @property
    def succeeded(self) -> bool:
        """Whether all goals were reached without contact."""
        return self.contacts == 0 and all(g.result == "reached" for g in self.goals)

    @property
    def missed_m(self) -> float | None:
        """Distance from a goal that only the estimate reached; None without one."""
        off = self.true_goal_distance_m
        return None if off is None or off <= self.goal_tolerance_m else off

    def to_json(self) -> str:
        """Return one JSON object; numbers to four places, NaN and infinity as null."""
        return json.dumps(_plain(asdict(self)))


def _plain(value: object) -> object:
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, float):
        return round(value, 4) if math.isfinite(value) else None
    return value
