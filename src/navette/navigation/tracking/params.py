"""Parameters of the tracking stage."""

from dataclasses import dataclass

from navette.navigation.shared_params import FrameParams
from navette.params import param


@dataclass(frozen=True, kw_only=True)
class TrackingParams(FrameParams):
    """Detection of what moves, association, and the filter of its motion."""

    rate_hz: float = param(
        20.0, "scans that are used per second, at most", at_least=1.0, at_most=200.0
    )
    range_m: float = param(
        10.0,
        "distance from the sensor up to which is tracked",
        above=0.0,
        at_most=100.0,
    )
    max_size_m: float = param(
        1.6, "largest extent of a moving obstacle", above=0.0, at_most=10.0
    )
    min_speed_mps: float = param(
        0.15, "speed from which an obstacle counts as moving", above=0.0
    )
    free_margin_m: float = param(
        0.15,
        "a return this far before what an earlier beam measured is a new obstacle; "
        "must exceed noise and errors of the pose",
        above=0.0,
    )
    gap_m: float = param(
        0.25, "distance between neighbouring returns of one obstacle", above=0.0
    )
    measurement_stddev_m: float = param(0.03, "error of a measured centre", above=0.0)
    acceleration_mps2: float = param(
        1.3,
        "stddev of an obstacle's acceleration, which lasts half a second",
        above=0.0,
    )
    gate_m: float = param(
        0.5, "largest distance between predicted and measured centre", above=0.0
    )
    memory_s: float = param(
        1.5, "time that an obstacle is predicted without being seen", at_least=0.0
    )
