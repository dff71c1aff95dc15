"""Summary of a run, as printed by ``--json``."""

import json
import math
from dataclasses import asdict, dataclass

from navette.navigation.missions import GoalOutcome
from navette.navigation.stack.pose_error import PoseError


@dataclass(frozen=True)
class RunSummary:
    """Summary of a run; ``min_clearance_m`` is from the body to the nearest obstacle.

    Seconds are simulated unless named otherwise. Goals are judged by the estimated
    pose; ``pose_error_m`` is its distance from the true one.
    """

    goals: tuple[GoalOutcome, ...]
    contacts: int
    min_clearance_m: float | None
    sim_time_s: float
    wall_time_s: float
    real_time_factor: float
    seed: int
    pose_error_m: PoseError

    @property
    def succeeded(self) -> bool:
        """Whether all goals were reached without contact."""
        return self.contacts == 0 and all(g.result == "reached" for g in self.goals)

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
