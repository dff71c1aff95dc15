"""Parameters of the localizer."""

from dataclasses import dataclass

from navette.params import Params, param


@dataclass(frozen=True, kw_only=True)
class LocalizerParams(Params):
    """Frames, and how often the pose is published."""

    map_frame: str = param("map", "frame of the pose")
    base_frame: str = param("base_link", "frame whose pose it is")
    update_distance_m: float = param(
        0.25, "motion after which the pose is published", unit="m", at_least=0.0
    )
    update_angle_rad: float = param(
        0.2, "turn after which the pose is published", unit="rad", at_least=0.0
    )
    initial_pose_tolerance_m: float = param(
        0.5, "distance from the estimate at which an initial pose is reported as wrong",
        unit="m", above=0.0,
    )  # fmt: skip
