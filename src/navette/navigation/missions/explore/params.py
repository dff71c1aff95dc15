"""Parameters of the explorer."""

from dataclasses import dataclass

from navette.navigation.missions.explore.frontiers import FrontierParams
from navette.navigation.shared_params import FrameParams
from navette.params import param


@dataclass(frozen=True, kw_only=True)
class ExplorerParams(FrameParams):
    """Which frontiers are driven to, and when exploration ends."""

    clearance_m: float = param(
        0.35, "distance of a goal from obstacles", at_least=0.0, at_most=10.0
    )
    passage_m: float = param(
        0.3,
        "distance from obstacles that the robot needs to pass between them",
        unit="m",
        at_least=0.0,
        at_most=10.0,
    )
    lethal_cost: int = param(
        100, "map cost from which a cell is an obstacle", at_least=1, at_most=100
    )
    min_frontier_m: float = param(0.6, "shorter frontiers are ignored", above=0.0)
    viewpoint_m: float = param(
        2.0,
        "largest distance from a frontier to the goal in front of it",
        above=0.0,
        at_most=10.0,
    )
    frontier_gain: float = param(
        1.0, "metres of path that compensate for a metre of frontier", at_least=0.0
    )
    map_timeout_s: float = param(
        15.0, "exploration ends if no map has arrived for this long", above=0.0
    )
    max_failures: int = param(
        8,
        "goals that fail one after another before exploration ends",
        at_least=1,
        at_most=1_000_000,
    )

    @property
    def frontier(self) -> FrontierParams:
        """The values of the choice of a frontier."""
        return FrontierParams(
            clearance_m=self.clearance_m,
            lethal_cost=self.lethal_cost,
            min_length_m=self.min_frontier_m,
            viewpoint_m=self.viewpoint_m,
            gain=self.frontier_gain,
            passage_m=self.passage_m,
        )
