"""Options of ``navette bench``."""

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from navette.cli.methods import MethodOptions
from navette.cli.options import Argument, Option


@dataclass(frozen=True, kw_only=True)
class TrialOptions:
    """Which trials are driven, and with what."""

    suite: Annotated[
        str,
        Argument(
            help="Worlds to drive: course, the reference world; generated ones:"
            " barn-like, rooms, office, maze, forest, random (all of these),"
            " dynabarn-like (moving cylinders); data sets with --data: barn, dynabarn."
        ),
    ]
    data: Annotated[
        Path | None, Option("--data", help="Folder of the data set, such as BARN's.")
    ] = None
    worlds: Annotated[
        str,
        Option(
            "--worlds",
            metavar="N,…",
            help="Worlds by number, as 1,4,7-9; of the course its runs. Default: all;"
            " of generated ones 0-9.",
        ),
    ] = ""
    robot: Annotated[
        str | None, Option("--robot", help="Robot to use instead of the suite's.")
    ] = None
    methods: MethodOptions
    params: Annotated[
        list[Path] | None,
        Option(metavar="FILE", help="ROS 2 parameter file. Repeat for several."),
    ] = None
    trials: Annotated[
        int | None,
        Option(
            "--trials",
            metavar="N",
            help="Drive every world N times, with the seeds 0 … N-1.",
            min=1,
        ),
    ] = None
    seeds: Annotated[
        str,
        Option(
            "--seeds",
            metavar="N,…",
            help="Seeds of the noise; every world is driven once per seed. Default: 0.",
        ),
    ] = ""


@dataclass(frozen=True, kw_only=True)
class BenchOptions:
    """Trials, and what happens with their results."""

    trials: TrialOptions
    jobs: Annotated[
        int,
        Option("--jobs", help="Trials at the same time. Default: one per core.", min=1),
    ] = os.cpu_count() or 1
    results: Annotated[
        Path | None,
        Option(
            "--results",
            help="Keep results in this file; trials that it contains are not repeated.",
        ),
    ] = None
    dask: Annotated[
        str | None,
        Option(
            "--dask",
            metavar="ADDRESS",
            help="Run on the workers of this Dask scheduler, as tcp://host:8786.",
        ),
    ] = None
    compare: Annotated[
        list[str] | None,
        Option(
            "--compare",
            metavar="BASELINE [MINE]",
            takes_words=True,
            help="Compare two: baseline (the robot's own methods), mine (those of the"
            " options), settings as controller=mppi,control.cruise_speed_mps=1.5, or a"
            " file of --results. Exit with 1 if success or score of mine are"
            " significantly worse.",
        ),
    ] = None
    report: Annotated[
        Path | None, Option("--report", help="Write a report as HTML.")
    ] = None
    as_json: Annotated[bool, Option("--json", help="Print the summary as JSON.")] = (
        False
    )
    min_success: Annotated[
        float,
        Option(
            "--min-success",
            help="Exit with 1 if a smaller share of the trials succeeds.",
            min=0,
            max=1,
        ),
    ] = 0.0
