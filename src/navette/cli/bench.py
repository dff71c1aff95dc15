"""``navette bench``: drive sets of worlds and measure."""

import dataclasses
import json
import math
import os
import shlex
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import click

from navette.cli.options import Argument, Option
from navette.errors import InvalidValueError

if TYPE_CHECKING:
    from navette.bench.statistics import MeasureDifference, Summary
    from navette.bench.trial import Trial, TrialResult


def bench(
    suite: Annotated[
        str,
        Argument(
            help="BARN's 300 worlds or DynaBARN's moving obstacles (barn, dynabarn,"
            " with --data), generated worlds (random, barn-like, forest,"
            " dynabarn-like, …) or the course."
        ),
    ],
    data: Annotated[
        Path | None, Option("--data", help="Folder of the data set, such as BARN's.")
    ] = None,
    worlds: Annotated[
        str,
        Option(
            "--worlds",
            metavar="N,…",
            help="Worlds by number, as 1,4,7-9. Default: all; of generated ones 0-9.",
        ),
    ] = "",
    robot: Annotated[
        str | None, Option("--robot", help="Robot to use instead of the suite's.")
    ] = None,
    controller: Annotated[
        str | None,
        Option("--controller", help="Method of the controller, such as mppi."),
    ] = None,
    planner: Annotated[
        str | None, Option("--planner", help="Method of the planner.")
    ] = None,
    param: Annotated[
        list[str] | None,
        Option(
            "-p",
            "--param",
            metavar="NODE.NAME=VALUE",
            help="Set a parameter. Repeat for several.",
        ),
    ] = None,
    seeds: Annotated[
        str,
        Option(
            "--seeds",
            metavar="N,…",
            help="Seeds of the noise; every world is driven once per seed.",
        ),
    ] = "0",
    jobs: Annotated[
        int,
        Option("--jobs", help="Trials at the same time. Default: one per core.", min=1),
    ] = os.cpu_count() or 1,
    results: Annotated[
        Path | None,
        Option(
            "--results",
            help="Keep results in this file; trials that it contains are not repeated.",
        ),
    ] = None,
    compare: Annotated[
        Path | None,
        Option("--compare", help="Compare with the results in this file of --results."),
    ] = None,
    report: Annotated[
        Path | None, Option("--report", help="Write a report as HTML.")
    ] = None,
    as_json: Annotated[
        bool, Option("--json", help="Print the summary as JSON.")
    ] = False,
    min_success: Annotated[
        float,
        Option(
            "--min-success",
            help="Exit with 1 if a smaller share of the trials succeeds.",
            min=0,
            max=1,
        ),
    ] = 0.0,
) -> None:
    """Drive a set of worlds and measure success, contacts, time and score."""
    from navette.bench.runner import read_results, run_trials
    from navette.bench.statistics import compare as compared
    from navette.bench.statistics import summarize
    from navette.bench.suites import suite_trials

    trials = _trials(
        suite_trials(
            suite, data=data, worlds=_numbers("--worlds", worlds), robot=robot
        ),
        _numbers("--seeds", seeds),
        _parameters(param or (), controller, planner),
    )
    found = _with_progress(run_trials(trials, jobs=jobs, results_file=results), trials)
    summary = summarize(found)
    against = (
        [] if compare is None else compared(list(read_results(compare).values()), found)
    )
    if report is not None:
        _write_report(report, suite, summary, found, against, trials)
    if as_json:
        click.echo(json.dumps(_plain(summary, against)))
    else:
        _print(summary, against)
    if summary.success < min_success:
        raise click.exceptions.Exit(1)


def _trials(
    base: Sequence["Trial"], seeds: Sequence[int], parameters: dict[str, dict[str, Any]]
) -> list["Trial"]:
    return [
        dataclasses.replace(trial, seed=seed, parameters=parameters)
        for seed in seeds or (0,)
        for trial in base
    ]


def _numbers(option: str, text: str) -> tuple[int, ...]:
    """Return the numbers of ``1,4,7-9``."""
    numbers: list[int] = []
    for part in filter(None, text.split(",")):
        first, _, last = part.partition("-")
        if not first.isdigit() or (last and not last.isdigit()):
            raise InvalidValueError(f"{option} {text!r}: expected numbers as 1,4,7-9")
        numbers += range(int(first), int(last or first) + 1)
    return tuple(numbers)


def _parameters(
    assignments: Sequence[str], controller: str | None, planner: str | None
) -> dict[str, dict[str, Any]]:
    """Return node → parameter → value of the options.

    Raises:
        InvalidValueError: not of the form NODE.NAME=VALUE.
    """
    from navette.runtime.parameter_files import parse_value

    found: dict[str, dict[str, Any]] = {}
    for text in assignments:
        name, equals, value = text.partition("=")
        node, dot, parameter = name.partition(".")
        if not (equals and dot and node and parameter):
            raise InvalidValueError(
                f"-p {text!r}: expected NODE.NAME=VALUE, as control.cruise_speed_mps=1"
            )
        found.setdefault(node, {})[parameter] = parse_value(value)
    for node, method in (("control", controller), ("planner", planner)):
        if method is not None:
            found.setdefault(node, {})["method"] = method
    return found


def _with_progress(results: Any, trials: Sequence["Trial"]) -> list["TrialResult"]:
    """Collect the results in the order of the trials, behind a bar."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

    found: list[TrialResult] = []
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn())
    console = Console(stderr=True)
    with Progress(*columns, console=console, transient=True) as progress:
        task = progress.add_task("trials", total=len(trials))
        for result in results:
            found.append(result)
            failed = sum(not each.succeeded for each in found)
            progress.update(task, advance=1, description=f"trials, {failed} failed")
    order = {(t.suite, t.name, t.seed): i for i, t in enumerate(trials)}
    return sorted(found, key=lambda r: order[r.suite, r.name, r.seed])


def replay_command(trial: "Trial") -> str:
    """Return the command that repeats a trial with the live view."""
    if trial.suite == "dynabarn":
        file, _, number = trial.world.removeprefix("dynabarn:").rpartition(":")
        words = ["navette", "bench", "dynabarn", "--data", str(Path(file).parent)]
        words += ["--worlds", number, "--seeds", str(trial.seed), "--jobs", "1"]
        return shlex.join(words)
    if ":" in trial.world:
        kind, _, seed = trial.world.partition(":")
        return f"navette bench {kind} --worlds {seed} --seeds {trial.seed} --jobs 1"
    words = ["navette", "sim", trial.world, "--seed", str(trial.seed)]
    if trial.robot is not None:
        words += ["--robot", trial.robot]
    if trial.start is not None:
        x, y, yaw = trial.start
        words += ["--start", f"{x:g}", f"{y:g}", f"{math.degrees(yaw):g}"]
    for x, y in trial.goals:
        words += ["--goal", f"{x:g},{y:g}"]
    return shlex.join(words)


def _write_report(
    file: Path,
    suite: str,
    summary: "Summary",
    results: Sequence["TrialResult"],
    against: Sequence["MeasureDifference"],
    trials: Sequence["Trial"],
) -> None:
    from navette.bench.report import report_page

    commands = {(t.name, t.seed): replay_command(t) for t in trials}
    page = report_page(
        f"navette bench {suite}",
        summary,
        results,
        against,
        [commands[each.name, each.seed] for each in results],
    )
    file.write_text(page, encoding="utf-8")
    sys.stderr.write(f"report: {file}\n")


def _print(summary: "Summary", against: Sequence["MeasureDifference"]) -> None:
    low, high = 100 * summary.success_low, 100 * summary.success_high
    click.echo(
        f"trials             {summary.trials}\n"
        f"success            {100 * summary.success:.1f} %  "
        f"(95 % interval {low:.1f}–{high:.1f} %)\n"
        f"contacts           {summary.contacts}\n"
        f"score              {_known(summary.score, 4)}  (of 0.5; this simulator)\n"
        f"time               {_known(summary.time_s, 2)} s\n"
        f"path / shortest    {_known(summary.path_ratio, 2)}\n"
        f"minimum clearance  {summary.min_clearance_m:.3f} m\n"
        f"outcomes           {_listed(summary.outcomes)}\n"
        "lost seconds       "
        + ", ".join(f"{k} {v:.2f}" for k, v in summary.lost_s.items())
    )
    for each in against:
        click.echo(
            f"against baseline   {each.measure} {each.difference:+.4f} "
            f"(p = {each.p_value:.4f}, {each.pairs} pairs)"
        )


def _known(value: float, digits: int) -> str:
    return f"{value:.{digits}f}" if math.isfinite(value) else "–"


def _listed(outcomes: dict[str, int]) -> str:
    return ", ".join(f"{name} {count}" for name, count in outcomes.items())


def _plain(
    summary: "Summary", against: Sequence["MeasureDifference"]
) -> dict[str, Any]:
    """Return the summary for JSON; NaN as null."""
    values = {
        key: None if isinstance(value, float) and math.isnan(value) else value
        for key, value in dataclasses.asdict(summary).items()
    }
    return values | {"comparison": [dataclasses.asdict(each) for each in against]}
