"""Parameters of the planner."""

from dataclasses import dataclass

from navette.errors import ParameterError
from navette.params import Params, param

METHODS = ("a_star", "dijkstra", "breadth_first")


@dataclass(frozen=True, kw_only=True)
class PlannerParams(Params):
    """How the planner sees the map, what it avoids, and when it plans again."""

    map_frame: str = param("map", "frame of the map and of the path")
    base_frame: str = param("base_link", "frame that is driven: the axle's midpoint")
    method: str = param("a_star", "search on the grid", choices=METHODS)

    footprint_m: tuple[float, ...] = param(
        (0.25, 0.2, -0.25, 0.2, -0.25, -0.2, 0.25, -0.2),
        "corners x1, y1, x2, y2, … of the body in the base frame",
        unit="m",
    )
    clearance_margin_m: float = param(
        0.15, "distance kept between body and obstacles", unit="m", at_least=0.0
    )
    tight_margin_m: float = param(
        0.05, "distance kept where there is no way with the margin", unit="m",
        at_least=0.0,
    )  # fmt: skip
    comfort_m: float = param(
        0.3,
        "distance, beyond the margin and the circle that a turn in place sweeps, "
        "that is kept where there is room",
        unit="m",
        at_least=0.0,
    )
    clearance_weight: float = param(
        3.0,
        "a metre at the edge of the inflation costs this many more than a free one",
        at_least=0.0,
        at_most=50.0,
    )
    lethal_cost: int = param(
        100, "map cost from which a cell is an obstacle", at_least=1, at_most=100
    )
    map_cost_weight: float = param(
        0.0,
        "what the map's own cost of 99 adds to a metre; the clearance to obstacles "
        "is counted without it",
        at_least=0.0,
        at_most=50.0,
    )
    allow_unknown: bool = param(True, "whether paths may cross unknown cells")
    unknown_cost: float = param(
        0.25,
        "what a metre through unknown cells costs more than a free one",
        at_least=0.0,
        at_most=50.0,
    )

    goal_tolerance_m: float = param(
        0.5, "how near counts as reached, and how far a goal may be moved", unit="m",
        above=0.0,
    )  # fmt: skip
    path_end_tolerance_m: float = param(
        0.1, "distance to the path's end at which the robot need not stand still",
        unit="m", above=0.0,
    )  # fmt: skip
    goal_yaw_tolerance_rad: float = param(
        0.2, "heading error at which a goal pose counts as reached", unit="rad",
        above=0.0, at_most=3.2,
    )  # fmt: skip
    deviation_m: float = param(
        0.8, "distance from the path at which it is planned anew", unit="m", above=0.0
    )
    path_spacing_m: float = param(
        0.1, "largest distance between poses of the path", unit="m", above=0.0
    )
    turn_threshold_rad: float = param(
        0.8,
        "heading error from which the path begins with a turn in place",
        unit="rad",
        above=0.0,
        at_most=3.2,
    )
    turn_cost_m_per_rad: float = param(
        0.5, "cost of turning in place, in metres per radian", unit="m/rad",
        at_least=0.0,
    )  # fmt: skip
    reverse_factor: float = param(
        1.5, "what a metre backwards is worth in metres forwards", at_least=1.0
    )
    max_expansions: int = param(
        40_000, "poses that the search with headings may look at", at_least=100
    )

    plan_period_s: float = param(
        0.5, "how often goal, progress and path are checked", unit="s", above=0.0
    )
    odometry_timeout_s: float = param(
        0.5, "age from which odometry is stale and the robot stops", unit="s", above=0.0
    )
    progress_timeout_s: float = param(
        6.0, "time without progress along the path before planning again", unit="s",
        above=0.0,
    )  # fmt: skip
    progress_distance_m: float = param(
        0.2, "progress along the path that counts", unit="m", above=0.0
    )
    max_stuck_replans: int = param(
        4, "replans without progress before the goal is given up", at_least=0
    )
    goal_timeout_s: float = param(
        0.0, "time for one goal before it is given up; 0 = no limit", unit="s",
        at_least=0.0,
    )  # fmt: skip
    switch_gain: float = param(
        0.15,
        "share by which a new way must be cheaper before a good path is left",
        at_least=0.0,
        below=1.0,
    )

    def check(self) -> None:
        if self.path_end_tolerance_m > self.goal_tolerance_m:
            raise ParameterError(
                f"parameter 'path_end_tolerance_m': {self.path_end_tolerance_m!r} is "
                f"not allowed; wanted <= goal_tolerance_m ({self.goal_tolerance_m:g})"
            )
