"""Parameters of the planner."""

from dataclasses import dataclass

from navette.errors import ParameterError
from navette.geometry import ACKERMANN
from navette.navigation.planning.methods import PLANNERS
from navette.navigation.shared_params import BendParams
from navette.params import param

LEAST_EXPANSIONS = 100


@dataclass(frozen=True, kw_only=True)
class PlannerParams(BendParams):
    """Costs, clearances, tolerances and timeouts of the planner."""

    method: str = param(
        "a_star", "search on the grid, or a planner of your own", choices=PLANNERS
    )

    clearance_margin_m: float = param(
        0.15, "clearance between body and obstacles", at_least=0.0, at_most=2.0
    )
    tight_margin_m: float = param(
        0.03,
        "clearance where no path has clearance_margin_m",
        at_least=0.0,
        at_most=2.0,
    )
    comfort_m: float = param(
        0.3,
        "additional clearance, beyond the margin and the circle of a turn in place, "
        "where there is room",
        at_least=0.0,
        at_most=10.0,
    )
    clearance_weight: float = param(
        3.0,
        "additional cost of a metre at the least clearance, relative to a free one",
        at_least=0.0,
        at_most=50.0,
    )
    map_cost_weight: float = param(
        0.0,
        "additional cost of a metre at map cost 99; the cost of low clearance does not "
        "depend on it",
        at_least=0.0,
        at_most=50.0,
    )
    allow_unknown: bool = param(True, "whether paths may cross unknown cells")
    unknown_cost: float = param(
        0.25,
        "additional cost of a metre through unknown cells, relative to a free one",
        at_least=0.0,
        at_most=50.0,
    )

    max_size_m: float = param(
        500.0,
        "largest edge of the map with a goal outside it, up to 10000 cells",
        above=0.0,
    )
    moving_horizon_s: float = param(
        2.0,
        "paths avoid where moving obstacles will be within this time; 0: nowhere",
        at_least=0.0,
        at_most=10.0,
    )
    goal_tolerance_m: float = param(
        0.5, "distance that counts as reached; a goal may be moved by it", above=0.0
    )
    path_end_tolerance_m: float = param(
        0.1,
        "distance to the path's end that counts as reached without stopping",
        above=0.0,
    )
    goal_yaw_tolerance_rad: float = param(
        0.2,
        "heading error at which a goal pose counts as reached",
        above=0.0,
        at_most=3.2,
    )
    deviation_m: float = param(
        0.8, "distance from the path at which the planner plans again", above=0.0
    )
    path_spacing_m: float = param(
        0.1, "largest distance between poses of the path", at_least=0.01
    )
    turn_threshold_rad: float = param(
        0.8,
        "heading error above which the path begins with a turn in place",
        above=0.0,
        at_most=3.2,
    )
    turn_cost_m_per_rad: float = param(
        0.5, "cost of turning in place, in metres per radian", at_least=0.0
    )
    reverse_factor: float = param(
        1.5, "cost of a metre in reverse, in metres forward", at_least=1.0
    )
    max_expansions: int = param(
        160_000,
        "largest number of poses that the search with headings expands, where a body "
        "that turns in place fits through",
        at_least=LEAST_EXPANSIONS,
        at_most=1_000_000,
    )

    plan_period_s: float = param(
        0.5, "period of checking goal, progress and path", at_least=0.001
    )
    odometry_timeout_s: float = param(
        0.5, "age at which odometry is stale and the robot stops", above=0.0
    )
    progress_timeout_s: float = param(
        6.0, "time without progress along the path before planning again", above=0.0
    )
    progress_distance_m: float = param(
        0.2, "least progress along the path that counts", above=0.0
    )
    max_stuck_replans: int = param(
        4,
        "replans without progress before the goal fails (stuck)",
        at_least=0,
        at_most=1_000_000,
    )
    goal_timeout_s: float = param(
        0.0, "time for one goal before it fails (timed_out); 0: no limit", at_least=0.0
    )
    switch_gain: float = param(
        0.15,
        "share by which a new path must be cheaper to replace a valid one",
        at_least=0.0,
        below=1.0,
    )

    @property
    def turns_in_place(self) -> bool:
        """Whether the base can turn in place."""
        return self.drive != ACKERMANN

    def check(self) -> None:
        super().check()
        if self.path_end_tolerance_m > self.goal_tolerance_m:
            raise ParameterError(
                f"parameter 'path_end_tolerance_m': {self.path_end_tolerance_m!r} is "
                f"not allowed; must be <= goal_tolerance_m ({self.goal_tolerance_m:g})"
            )
