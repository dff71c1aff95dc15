"""Parameters of the localizer."""

from dataclasses import dataclass

from navette.navigation.shared_params import FrameParams
from navette.params import param


@dataclass(frozen=True, kw_only=True)
class LocalizerParams(FrameParams):
    """Frames, and how often the pose is published."""

    update_distance_m: float = param(
        0.25, "motion after which the pose is published", at_least=0.0
    )
    update_angle_rad: float = param(
        0.2, "turn after which the pose is published", at_least=0.0
    )
    initial_pose_tolerance_m: float = param(
        0.5,
        "distance from the estimate at which an initial pose is reported as wrong",
        above=0.0,
    )
