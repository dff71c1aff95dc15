"""The sets of trials by name."""

import math
from dataclasses import replace
from pathlib import Path

from navette.errors import InvalidValueError, UnknownNameError
from navette.geometry import Footprint, Pose2
from navette.navigation.bench.barn import barn_trials
from navette.navigation.bench.dynabarn import FILE as DYNABARN_FILE
from navette.navigation.bench.dynabarn import dynabarn_trial, dynabarn_trials
from navette.navigation.bench.trial import Trial
from navette.navigation.stack.options import RunOptions
from navette.navigation.stack.scene import resolve_scene
from navette.navigation.worlds import moving_worlds
from navette.navigation.worlds.generators import GENERATORS, generate
from navette.navigation.worlds.shortest import shortest_around
from navette.sim import Simulator, footprint_of

SUITES = ("barn", "dynabarn", "course", "random", *GENERATORS, moving_worlds.KIND)
"""``barn`` and ``dynabarn`` require their data sets; ``random`` is every generator of
worlds in which nothing moves."""

_COURSE_LIMIT_S = 124.0
_COURSE = ((-6, -12), (6, -12), (12, 0), (6, 12.5), (-12, 11), (-3, 3), (-6, 0))
# Start (x, y, degrees), goal and limit: hard runs in the reference world.
_HARD_RUNS = (
    ("corridor", (1, -12.9, 0), (-6, -12.9), 90),
    ("round-the-box", (1, -12.9, 180), (1, -7.2), 90),
    ("box-and-wall", (6, -12.8, 90), (2.8, -6.5), 90),
    ("into-the-corner", (-12, -9, -110), (-13.2, -13.2), 60),
    ("out-of-the-corner", (-13.2, -13.2, -135), (-12, -9), 90),
    ("behind-the-box", (0, 12.6, 0), (4, 6), 90),
    ("between-boxes", (11.5, 7.5, 180), (6, 4.5), 90),
    ("up-to-a-face", (-3, 6, 180), (-5.3, 6), 60),
    ("past-the-box", (-12, -1, 90), (-4.5, 9), 90),
    ("along-the-wall", (-11, 12.6, 0), (11, 12.6), 90),
)


def suite_trials(
    suite: str, *, data: Path | None, worlds: tuple[int, ...], robot: str | None
) -> list[Trial]:
    """Return the trials of a suite with seed 0.

    Args:
        suite: one of :data:`SUITES`.
        data: folder of a data set.
        worlds: numbers of worlds, or of the runs of the course; empty = all of a data
            set and the course, 0 … 9 of a generator (0 … 29 of ``dynabarn-like``).
        robot: instead of the suite's own.

    Raises:
        UnknownNameError: unknown suite; the text lists the known ones.
        InvalidValueError: a missing folder or world.
    """
    if suite not in SUITES:
        raise UnknownNameError.of("suite", suite, list(SUITES))
    if suite == "barn":
        if data is None:
            raise InvalidValueError(
                "suite barn: --data FOLDER with worlds/world_N.world and "
                "paths/path_N.npy is required; barn-like needs no data"
            )
        trials = barn_trials(data, worlds)
    elif suite == "dynabarn":
        if data is None:
            raise InvalidValueError(
                f"suite dynabarn: --data FOLDER with {DYNABARN_FILE} is required; "
                "dynabarn-like needs no data"
            )
        trials = dynabarn_trials(data, worlds)
    elif suite == moving_worlds.KIND:
        trials = [
            dynabarn_trial(suite, f"{suite}-{seed}", f"{suite}:{seed}")
            for seed in worlds or range(30)
        ]
    elif suite == "course":
        trials = _course_trials(worlds)
    else:
        kinds = tuple(GENERATORS) if suite == "random" else (suite,)
        seeds = worlds or tuple(range(10))
        trials = [_generated(suite, kind, seed) for kind in kinds for seed in seeds]
    return [replace(t, robot=robot) for t in trials] if robot else trials


def _course_trials(numbers: tuple[int, ...]) -> list[Trial]:
    """Return the runs in the reference world, or those with the given numbers."""
    runs = [
        Trial(
            suite="course",
            name=name,
            world="course",
            robot="course",
            start=Pose2(x, y, math.radians(degrees)),
            goals=(goal,),
            limit_s=limit_s,
        )
        for name, (x, y, degrees), goal, limit_s in _HARD_RUNS
    ]
    whole = Trial(
        suite="course",
        name="seven-goals",
        world="course",
        robot="course",
        goals=_COURSE,
        limit_s=_COURSE_LIMIT_S,
    )
    trials = [*runs, whole]
    missing = [number for number in numbers if number >= len(trials)]
    if missing:
        names = ", ".join(f"{i} {each.name}" for i, each in enumerate(trials))
        raise InvalidValueError(
            f"runs {missing}: not in the course; available: {names}"
        )
    return _with_shortest([trials[i] for i in numbers] or trials)


def _with_shortest(trials: list[Trial]) -> list[Trial]:
    """Return trials in one world, with the lengths of their shortest paths."""
    resolved = resolve_scene(RunOptions(world=trials[0].world, robot=trials[0].robot))
    simulator = Simulator(resolved.scene)
    outlines = simulator.outlines()
    model = resolved.scene.robot
    assert model is not None, "a resolved scene has a robot"
    radius_m = Footprint(footprint_of(model)).inscribed_radius
    x, y, _ = simulator.pose().translation
    found = []
    for trial in trials:
        start = (x, y) if trial.start is None else (trial.start.x, trial.start.y)
        length = shortest_around(outlines, [start, *trial.goals], radius_m)
        found.append(replace(trial, shortest_m=length))
    return found


def _generated(suite: str, kind: str, seed: int) -> Trial:
    world = generate(kind, seed)
    return Trial(
        suite=suite,
        name=f"{kind}-{seed}",
        world=f"{kind}:{seed}",
        robot="jackal",
        start=world.start,
        goals=(world.goal,),
        reach_m=1.0,
        limit_s=max(100.0, 6 * world.shortest_m),
        shortest_m=world.shortest_m,
    )
