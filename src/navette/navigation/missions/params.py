"""Parameters of the missions stage."""

import math
from dataclasses import dataclass

from navette.errors import ParameterError
from navette.params import Params, param


@dataclass(frozen=True, kw_only=True)
class MissionParams(Params):
    """Goals, timeout and failure rule."""

    map_frame: str = param("map", "frame of the goals and of the pose")
    base_frame: str = param("base_link", "frame whose path length is measured")
    goals_m: tuple[float, ...] = param((), "initial goals: x1, y1, …", unit="m")
    goal_timeout_s: float = param(
        300.0, "time after which a goal fails (timed_out); 0: no limit", unit="s",
        at_least=0.0,
    )  # fmt: skip
    on_failure: str = param(
        "continue", "what to do after a failed goal", choices=("continue", "stop")
    )
    wait_for_map: bool = param(True, "send the first goal after a map has arrived")
    rate_hz: float = param(10.0, "rate of checks", unit="Hz", at_least=1.0)

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
