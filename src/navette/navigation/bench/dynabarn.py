"""Trials in the worlds of DynaBARN: cylinders that move through a walled field.

Nair et al., "DynaBARN: Benchmarking Metric Ground Navigation in Dynamic Environments"
(SSRR 2022): 20 m × 20 m, the robot starts outside the open side and drives 20 m across.
Success, time limit and score are those of the BARN challenge, whose runner drives these
worlds too; the shortest path is the straight line.
"""

import math
from pathlib import Path

from navette.errors import InvalidValueError
from navette.navigation.bench.trial import Trial
from navette.navigation.worlds.dynabarn import PREFIX, START, obstacles_of

GOAL = (-9.0, 0.0)
FILE = "trajectories.json"


def dynabarn_trials(folder: Path, numbers: tuple[int, ...] = ()) -> list[Trial]:
    """Return a trial for each world of ``trajectories.json``, or for the given numbers.

    Raises:
        InvalidValueError: a missing file or world.
        FileFormatError: the file has other content.
    """
    file = folder / FILE
    if not file.is_file():
        raise InvalidValueError(f"folder {str(folder)!r}: expected {FILE}")
    found = sorted(obstacles_of(file))
    missing = [number for number in numbers if number not in found]
    if missing:
        raise InvalidValueError(
            f"worlds {missing}: not in {str(file)!r}; available: {found}"
        )
    return [
        dynabarn_trial("dynabarn", f"world_{number}", f"{PREFIX}{file}:{number}")
        for number in numbers or found
    ]


def dynabarn_trial(suite: str, name: str, world: str) -> Trial:
    """Return the drive across a world of this kind."""
    return Trial(
        suite=suite,
        name=name,
        world=world,
        robot="jackal",
        start=START,
        goals=(GOAL,),
        reach_m=1.0,
        ends_at_contact=True,
        limit_s=100.0,
        shortest_m=math.dist(START[:2], GOAL),
    )
