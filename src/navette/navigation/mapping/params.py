"""Parameters of the map memory."""

from dataclasses import dataclass

from navette.errors import InvalidValueError, ParameterError
from navette.geometry import Footprint
from navette.params import Params, param


@dataclass(frozen=True, kw_only=True)
class MapMemoryParams(Params):
    """How costmaps become one map, and how often."""

    map_frame: str = param("map", "frame of the map")
    base_frame: str = param("base_link", "frame of the robot's base")
    resolution_m: float = param(0.1, "edge of a cell", unit="m", above=0.0, at_most=1.0)
    size_m: float = param(
        40.0, "edge of the square map at the start", unit="m", above=0.0
    )
    center_x_m: float = param(0.0, "its centre in the map frame", unit="m")
    center_y_m: float = param(0.0, "its centre in the map frame", unit="m")
    growth_m: float = param(
        10.0, "the map grows by whole multiples of this", unit="m", above=0.0
    )
    max_size_m: float = param(
        200.0, "the map's edges never exceed this", unit="m", above=0.0
    )
    fusion: str = param(
        "overwrite",
        "how a costmap joins the map: its known cells replace the map's, the larger "
        "cost wins, or evidence adds up",
        choices=("overwrite", "max", "log_odds"),
    )
    erase_range_m: float = param(
        5.0,
        "distance from the sensor from which on 'overwrite' keeps lethal cells: "
        "beams there are too far apart to vouch that a cell is free",
        unit="m",
        at_least=0.0,
    )
    update_period_s: float = param(
        1.0, "between checks whether the robot moved enough", unit="s", above=0.0
    )
    update_distance_m: float = param(
        1.5, "way after which the newest costmap is fused", unit="m", at_least=0.0
    )
    update_angle_rad: float = param(
        0.5, "turn after which the newest costmap is fused", unit="rad", at_least=0.0
    )
    max_yaw_rate_radps: float = param(
        1.5,
        "no fusing while turning faster: a scan takes time and would smear",
        unit="rad/s",
        above=0.0,
    )
    max_vertical_speed_mps: float = param(
        0.3,
        "no fusing while falling or rising faster: the scan is of another height",
        unit="m/s",
        above=0.0,
    )
    max_tilt_rad: float = param(
        0.15,
        "no fusing while tilted further: the scan looks over or under obstacles",
        unit="rad",
        above=0.0,
    )
    fuse_on_change: bool = param(
        True, "fuse at once when a costmap contradicts the map near the robot"
    )
    change_range_m: float = param(
        5.0, "how near: half the edge of the square compared", unit="m", above=0.0
    )
    change_cells: int = param(
        3, "obstacle cells that must have appeared or vanished", at_least=1
    )
    change_period_s: float = param(
        0.2, "at least this long between such updates", unit="s", at_least=0.0
    )
    pose_wait_s: float = param(
        0.5,
        "how long a costmap waits for the pose at its stamp",
        unit="s",
        at_least=0.0,
    )
    footprint_m: tuple[float, ...] = param(
        (),
        "outline of the body in the base frame, x1, y1, x2, y2, …; cells wholly under "
        "it are free (empty: no such clearing)",
        unit="m",
    )
    hit_probability: float = param(
        0.7, "log_odds: belief in an obstacle after one hit", above=0.5, below=1.0
    )
    miss_probability: float = param(
        0.35, "log_odds: belief after one beam passed", above=0.0, below=0.5
    )
    belief_limit: float = param(
        0.97, "log_odds: belief never exceeds this", above=0.5, below=1.0
    )
    occupied_threshold: float = param(
        0.65, "log_odds: belief from which on a cell is lethal", above=0.5, below=1.0
    )

    def frames(self) -> tuple[str, str]:
        """(map frame, base frame)."""
        return (self.map_frame, self.base_frame)

    def shape(self) -> tuple[object, ...]:
        """The values that cannot change without starting the map anew."""
        return (
            *self.frames(),
            self.resolution_m,
            self.size_m,
            self.center_x_m,
            self.center_y_m,
            self.fusion,
        )

    def check(self) -> None:
        if self.footprint_m:
            try:
                Footprint.from_flat(self.footprint_m)
            except InvalidValueError as error:
                raise ParameterError(f"parameter 'footprint_m': {error}") from None
        if self.max_size_m < self.size_m:
            raise ParameterError(
                f"parameter 'max_size_m': {self.max_size_m} m; wanted at least size_m, "
                f"{self.size_m} m"
            )
        if self.max_size_m / self.resolution_m > 20_000:
            raise ParameterError(
                f"parameter 'max_size_m': {self.max_size_m} m at {self.resolution_m} m "
                f"per cell; wanted at most 20000 cells an edge"
            )
