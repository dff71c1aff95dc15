"""Parameters of the costmap stage."""

from dataclasses import dataclass

from navette.errors import ParameterError
from navette.navigation.costmap.methods import COSTMAPS
from navette.navigation.shared_params import FrameParams, check_footprint
from navette.params import param


@dataclass(frozen=True, kw_only=True)
class CostmapParams(FrameParams):
    """Geometry and inflation of the costmap."""

    method: str = param(
        "scan",
        "traces the beams, marks and inflates the hits; or a method of your own",
        choices=COSTMAPS,
    )
    rate_hz: float = param(
        20.0,
        "largest rate of costmaps: of a faster sensor, the last scan of each period is "
        "used; 0: every scan",
        at_least=0.0,
    )
    resolution_m: float = param(0.1, "edge of a cell", above=0.0, at_most=1.0)
    size_m: float = param(
        30.0,
        "edge of the square grid around the sensor; hits outside are ignored",
        above=0.0,
        at_most=200.0,
    )
    inflation_radius_m: float = param(
        1.0, "distance from an obstacle at which the cost reaches 0", at_least=0.0
    )
    inflation_method: str = param(
        "linear",
        "decrease of cost with distance d: max_cost (1 - d / inflation_radius_m), "
        "or max_cost exp(-inflation_decay_per_m d)",
        choices=("linear", "exponential"),
    )
    inflation_decay_per_m: float = param(
        3.0, "decay of the exponential inflation", at_least=0.0
    )
    max_cost: int = param(
        100,
        "cost next to an obstacle; cells with a hit have 100",
        at_least=0,
        at_most=100,
    )
    grazing_margin_m: float = param(
        0.5,
        "largest margin before a hit in which a grazing beam frees no cells, because "
        "the surface may lie in them",
        at_least=0.0,
        at_most=5.0,
    )

    footprint_m: tuple[float, ...] = param(
        (),
        "outline of the body in the base frame: x1, y1, x2, y2, …; what the obstacle "
        "layer marks inside is cleared; empty: nothing",
    )

    def check(self) -> None:
        super().check()
        if self.footprint_m:
            check_footprint(self.footprint_m)
        cells = self.size_m / self.resolution_m
        if not 1 <= cells <= 4000:
            raise ParameterError(
                f"parameter 'size_m': {self.size_m} m at a resolution of "
                f"{self.resolution_m} m is {cells:.0f} cells; expected 1 to 4000"
            )
        if self.inflation_radius_m > self.size_m:
            raise ParameterError(
                f"parameter 'inflation_radius_m': {self.inflation_radius_m} m; must "
                f"be at most size_m, {self.size_m} m"
            )
