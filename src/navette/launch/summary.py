"""What came of a run, as ``--json`` prints it."""

import json
import math
from dataclasses import asdict, dataclass


@dataclass(frozen=True)
class GoalReport:
    """One goal: where, how it ended (``reached`` or a named failure), what it cost.

    Seconds are simulated; ``distance_left_m`` is from the axle to the goal when it
    ended, measured in the simulator; NaN and infinity appear as null.
    """

    goal: tuple[float, float]
    result: str
    time_s: float
    path_length_m: float
    distance_left_m: float


@dataclass(frozen=True)
class RunSummary:
    """A whole run; ``min_clearance_m`` is from the body to the nearest obstacle."""

    goals: tuple[GoalReport, ...]
    contacts: int
    min_clearance_m: float | None
    sim_time_s: float
    wall_time_s: float
    real_time_factor: float
    seed: int

    @property
    def succeeded(self) -> bool:
        """All goals reached and nothing touched."""
        return self.contacts == 0 and all(g.result == "reached" for g in self.goals)

    def to_json(self) -> str:
        """One JSON object; numbers rounded to a tenth of a millimetre and so on."""
        return json.dumps(_plain(asdict(self)))


def _plain(value: object) -> object:
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, float):
        return round(value, 4) if math.isfinite(value) else None
    return value
