"""Parameters of the map memory."""

from dataclasses import dataclass

from navette.errors import ParameterError
from navette.navigation.mapping.methods import MAPPINGS
from navette.navigation.shared_params import FrameParams, check_footprint
from navette.params import param


@dataclass(frozen=True, kw_only=True)
class MapMemoryParams(FrameParams):
    """Geometry and fusion of the map."""

    resolution_m: float = param(0.1, "edge of a cell", above=0.0, at_most=1.0)
    size_m: float = param(40.0, "initial edge of the square map", above=0.0)
    center_x_m: float = param(0.0, "centre of the map in the map frame")
    center_y_m: float = param(0.0, "centre of the map in the map frame")
    growth_m: float = param(10.0, "the map grows by multiples of this", above=0.0)
    max_size_m: float = param(
        500.0,
        "largest edge of the map; with a map file of smaller cells, as many cells as "
        "with resolution_m",
        above=0.0,
    )
    map_file: str = param(
        "",
        "map file (YAML of map_server) to start with; scans change it; empty: unknown",
    )
    fusion: str = param(
        "overwrite",
        "how a costmap is fused: its known cells replace the map's, the larger cost is "
        "kept, evidence is accumulated, or a method of your own",
        choices=MAPPINGS,
    )
    erase_range_m: float = param(
        5.0,
        "distance from the sensor beyond which 'overwrite' keeps lethal cells: beams "
        "there are too far apart to measure that a cell is free",
        at_least=0.0,
    )
    always_send_full_map: bool = param(
        True,
        "publish the whole map at each update, for programs that read /map only; "
        "otherwise if its extent changed or a subscriber came, and the changed part on "
        "/map_updates",
    )
    update_period_s: float = param(
        1.0, "period of checking whether the robot moved far enough", at_least=0.001
    )
    update_distance_m: float = param(
        1.5, "distance driven after which the newest costmap is fused", at_least=0.0
    )
    update_angle_rad: float = param(
        0.5, "turn after which the newest costmap is fused", at_least=0.0
    )
    max_yaw_rate_radps: float = param(
        1.5, "no fusion while turning faster: the scan would be distorted", above=0.0
    )
    max_vertical_speed_mps: float = param(
        0.3,
        "no fusion while falling or rising faster: the scan is at another height",
        above=0.0,
    )
    max_tilt_rad: float = param(
        0.15,
        "no fusion while tilted further: the scan passes over or under obstacles",
        above=0.0,
    )
    fuse_on_change: bool = param(
        True, "fuse at once if an obstacle near the robot appeared or moved away"
    )
    change_range_m: float = param(
        5.0, "half the edge of the square that is compared", above=0.0
    )
    change_cells: int = param(
        3,
        "appeared or vanished obstacle cells that count as a change",
        at_least=1,
        at_most=1_000_000,
    )
    change_period_s: float = param(0.2, "least time between such updates", at_least=0.0)
    pose_wait_s: float = param(
        0.5, "time that a costmap waits for the pose at its stamp", at_least=0.0
    )
    footprint_m: tuple[float, ...] = param(
        (),
        "outline of the body in the base frame, x1, y1, x2, y2, …; cells wholly under "
        "it are marked free (empty: none)",
    )
    hit_probability: float = param(
        0.7, "log_odds: belief in an obstacle after one hit", above=0.5, below=1.0
    )
    miss_probability: float = param(
        0.35, "log_odds: belief after one beam passed", above=0.0, below=0.5
    )
    belief_limit: float = param(0.97, "log_odds: largest belief", above=0.5, below=1.0)
    occupied_threshold: float = param(
        0.65, "log_odds: belief from which a cell is lethal", above=0.5, below=1.0
    )

    def frames(self) -> tuple[str, str]:
        """(map frame, base frame)."""
        return (self.map_frame, self.base_frame)

    def shape(self) -> tuple[object, ...]:
        """The values whose change resets the map."""
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
            check_footprint(self.footprint_m)
        if self.max_size_m < self.size_m:
            raise ParameterError(
                f"parameter 'max_size_m': {self.max_size_m} m; must be at least "
                f"size_m, {self.size_m} m"
            )
        if self.max_size_m / self.resolution_m > 20_000:
            raise ParameterError(
                f"parameter 'max_size_m': {self.max_size_m} m at {self.resolution_m} m "
                f"per cell; must be at most 20000 cells an edge"
            )
