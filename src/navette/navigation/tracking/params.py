"""Parameters of the tracking stage."""

from dataclasses import dataclass

from navette.params import Params, param


@dataclass(frozen=True, kw_only=True)
class TrackingParams(Params):
    """Detection of what moves, association, and the filter of its motion."""

    map_frame: str = param("map", "frame of the obstacles")
    base_frame: str = param("base_link", "frame of the robot's base")
    rate_hz: float = param(
        20.0, "scans that are used per second, at most", unit="Hz", at_least=1.0,
        at_most=200.0,
    )  # fmt: skip
    range_m: float = param(
        10.0, "distance from the sensor up to which is tracked", unit="m", above=0.0,
        at_most=100.0,
    )  # fmt: skip
    max_size_m: float = param(
        1.6, "largest extent of a moving obstacle", unit="m", above=0.0, at_most=10.0
    )
    min_speed_mps: float = param(
        0.15, "speed from which an obstacle counts as moving", unit="m/s", above=0.0
    )
    free_margin_m: float = param(
        0.15,
        "a return this far before what an earlier beam measured is a new obstacle; "
        "must exceed noise and errors of the pose",
        unit="m",
        above=0.0,
    )
    gap_m: float = param(
        0.25, "distance between neighbouring returns of one obstacle", unit="m",
        above=0.0,
    )  # fmt: skip
    measurement_stddev_m: float = param(
        0.03, "error of a measured centre", unit="m", above=0.0
    )
    acceleration_mps2: float = param(
        1.3, "stddev of an obstacle's acceleration, which lasts half a second",
        unit="m/s²", above=0.0,
    )  # fmt: skip
    gate_m: float = param(
        0.5, "largest distance between predicted and measured centre", unit="m",
        above=0.0,
    )  # fmt: skip
    memory_s: float = param(
        1.5, "time that an obstacle is predicted without being seen", unit="s",
        at_least=0.0,
    )  # fmt: skip
