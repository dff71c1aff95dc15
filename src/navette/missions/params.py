"""Parameters of the missions stage."""

from dataclasses import dataclass

from navette.params import Params, param


@dataclass(frozen=True, kw_only=True)
class MissionParams(Params):
    """Which goals to send and how long to wait for each."""

    map_frame: str = param("map", "frame of the goals sent and of the pose")
    base_frame: str = param("base_link", "frame whose path length is measured")
    goals: tuple[float, ...] = param((), "goals to start with: x1, y1, …", unit="m")
    goal_timeout_s: float = param(
        300.0, "a goal not reached by then has timed out; 0: never", unit="s",
        at_least=0.0,
    )  # fmt: skip
    on_failure: str = param(
        "continue", "after a failed goal", choices=("continue", "stop")
    )
    wait_for_map: bool = param(True, "send the first goal only once /map was seen")
    rate_hz: float = param(10.0, "checks per second", unit="Hz", at_least=1.0)
