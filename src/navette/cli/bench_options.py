"""Options of ``navette bench``."""

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from navette.cli.options import Argument, Option


@dataclass(frozen=True, kw_only=True)
class TrialOptions:
    """Which trials are driven, and with what."""

    suite: Annotated[
        str,
        Argument(
            help="BARN's 300 worlds or DynaBARN's moving obstacles (barn, dynabarn,"
            " with --data), generated worlds (random, barn-like, forest,"
            " dynabarn-like, …) or the course."
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
            help="Worlds by number, as 1,4,7-9. Default: all; of generated ones 0-9.",
        ),
    ] = ""
    robot: Annotated[
        str | None, Option("--robot", help="Robot to use instead of the suite's.")
    ] = None
    controller: Annotated[
        str | None,
        Option("--controller", help="Method of the controller, such as mppi."),
    ] = None
    planner: Annotated[
        str | None, Option("--planner", help="Method of the planner.")
    ] = None
    param: Annotated[
        list[str] | None,
        Option(
            "-p",
            "--param",
            metavar="NODE.NAME=VALUE",
            help="Set a parameter. Repeat for several.",
        ),
    ] = None
    seeds: Annotated[
        str,
        Option(
            "--seeds",
            metavar="N,…",
            help="Seeds of the noise; every world is driven once per seed.",
        ),
    ] = "0"


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
    compare: Annotated[
        Path | None,
        Option("--compare", help="Compare with the results in this file of --results."),
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
