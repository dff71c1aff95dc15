"""The measured drives: ten hard runs and the course of the reference world."""

import math
from dataclasses import dataclass

from navette.geometry import Pose2

Point = tuple[float, float]


@dataclass(frozen=True)
class Drive:
    """A start (None: the pose in the world), goals and a time limit."""

    name: str
    start: Pose2 | None
    goals: tuple[Point, ...]
    limit_s: float


def _run(
    name: str, start: tuple[float, float, float], goal: Point, limit_s: float = 90.0
) -> Drive:
    x, y, yaw_deg = start
    return Drive(name, Pose2(x, y, math.radians(yaw_deg)), (goal,), limit_s)


HARD_RUNS = (
    _run("corridor, turn round", (1, -12.9, 0), (-6, -12.9)),
    _run("round the box", (1, -12.9, 180), (1, -7.2)),
    _run("between box and wall", (6, -12.8, 90), (2.8, -6.5)),
    _run("into the corner", (-12, -9, -110), (-13.2, -13.2), 60),
    _run("out of the corner", (-13.2, -13.2, -135), (-12, -9)),
    _run("behind the box", (0, 12.6, 0), (4, 6)),
    _run("between two boxes", (11.5, 7.5, 180), (6, 4.5)),
    _run("up to a face", (-3, 6, 180), (-5.3, 6), 60),
    _run("past the box", (-12, -1, 90), (-4.5, 9)),
    _run("along the wall", (-11, 12.6, 0), (11, 12.6)),
)
SEVEN_GOALS = Drive(
    "seven goals",
    None,
    ((-6, -12), (6, -12), (12, 0), (6, 12.5), (-12, 11), (-3, 3), (-6, 0)),
    124.0,
)
