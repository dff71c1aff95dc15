"""Parameters of the SLAM."""

from dataclasses import dataclass

from navette.errors import ParameterError
from navette.navigation.shared_params import FrameParams
from navette.params import param

MODES = MAPPING, LOCALIZATION = ("mapping", "localization")


@dataclass(frozen=True, kw_only=True)
class SlamParams(FrameParams):
    """Motion noise, scan matching, loop closure and the map."""

    odom_frame: str = param("odom", "frame of the odometry")
    start_x_m: float = param(0.0, "x of the robot in the map at the start")
    start_y_m: float = param(0.0, "y of the robot in the map at the start")
    start_yaw_rad: float = param(0.0, "heading of the robot in the map at the start")
    known_map: str = param(
        "", "file of `navette slam --save` or the service slam/save_map to begin with"
    )
    mode: str = param(
        MAPPING,
        "mapping: the map grows; localization: known_map stays as it is",
        choices=MODES,
    )
    searches_start: bool = param(
        False, "search all of known_map for the start, without a start pose"
    )
    rate_hz: float = param(
        10.0, "scans per second that are matched at most", at_least=0.1, at_most=100.0
    )
    pose_wait_s: float = param(
        0.3, "how long a scan waits for the odometry at its stamp", at_least=0.0
    )
    transform_tolerance_s: float = param(
        0.2, "how long map → odom is valid after its scan", at_least=0.0, at_most=10.0
    )
    map_period_s: float = param(
        5.0, "between two maps, while the map is subscribed to", at_least=0.1
    )
    lost_scans: int = param(
        20,
        "scans that contradict the map, without a match between them, after which the "
        "robot is lost; without odometry, or at the start in a known map: scans "
        "without a match",
        at_least=1,
        at_most=10_000,
    )
    lost_stddev_m: float = param(
        10.0,
        "standard deviation of the position beyond which the robot is lost, when "
        "nothing is in reach of the scanner and the odometry alone moves the pose",
        above=0.0,
    )

    # Scans
    max_range_m: float = param(
        30.0, "echoes beyond it are not matched", above=0.5, at_most=500.0
    )
    point_spacing_m: float = param(
        0.05, "least distance of neighbouring points of a scan", at_least=0.0
    )
    max_points: int = param(
        240, "points of a scan that are matched", at_least=30, at_most=5000
    )

    # Odometry between two scans
    odometry_noise: float = param(
        0.1, "standard deviation of a motion: metres per metre, radians per radian",
        above=0.0, at_most=2.0,
    )  # fmt: skip
    odometry_yaw_per_m: float = param(
        0.03, "standard deviation of yaw, rad, per distance",
        above=0.0, at_most=2.0,
    )  # fmt: skip
    odometry_floor_m: float = param(
        0.01, "standard deviation of the position without motion", above=0.0
    )
    odometry_floor_rad: float = param(
        0.005, "standard deviation of the yaw without motion", above=0.0
    )

    max_acceleration_mps2: float = param(
        1.0, "largest acceleration assumed without odometry", above=0.0
    )
    max_yaw_acceleration_radps2: float = param(
        2.0, "largest angular acceleration assumed without odometry", above=0.0,
    )  # fmt: skip

    # Key scans and scan matching
    key_distance_m: float = param(
        0.4, "motion after which a scan becomes a key scan", above=0.0
    )
    key_angle_rad: float = param(
        0.35, "turn after which a scan becomes a key scan", above=0.0
    )
    local_scans: int = param(
        12, "newest key scans that a scan is matched with", at_least=1, at_most=200
    )
    search_resolution_m: float = param(
        0.1, "cell of the correlative search", at_least=0.02, at_most=1.0
    )
    match_radius_m: float = param(
        0.3, "distance within which points correspond", above=0.02
    )
    match_noise_m: float = param(
        0.05, "standard deviation of a point's distance from the surface",
        above=0.0,
    )  # fmt: skip
    min_overlap: float = param(
        0.2, "least share of points with a correspondence", at_least=0.0, at_most=1.0
    )
    max_contradicted: float = param(
        0.35, "largest share of points, of the scan or of the map, that are where the "
        "other one is free; the place is another one beyond it",
        above=0.0, at_most=1.0,
    )  # fmt: skip

    # Loop closure
    submap_scans: int = param(
        10, "key scans of a submap at most", at_least=2, at_most=200
    )
    submap_length_m: float = param(
        5.0, "path after which a submap with fewer key scans is complete", above=0.0
    )
    loop_search_max_m: float = param(
        15.0, "largest distance searched for a loop closure", above=0.0
    )
    loop_reach_m: float = param(
        6.0, "distance of submaps that see the same surfaces", above=0.0
    )
    loop_targets: int = param(
        6, "submaps that are searched at a time", at_least=1, at_most=100
    )
    loop_min_score: float = param(
        0.55, "least mean likelihood of a loop closure", above=0.0, at_most=1.0
    )
    loop_min_overlap: float = param(
        0.6, "least share of points with a correspondence in a loop closure",
        above=0.0, at_most=1.0,
    )  # fmt: skip

    # Map
    resolution_m: float = param(
        0.05, "edge of a cell of the map", at_least=0.01, at_most=1.0
    )
    free_range_m: float = param(
        5.0, "how far a beam without an echo counts as free", at_least=0.1
    )

    def check(self) -> None:
        super().check()
        if self.mode == LOCALIZATION and not self.known_map:
            raise ParameterError(
                "parameter 'mode': 'localization' needs the file 'known_map'"
            )
