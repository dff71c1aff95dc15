"""``navette bench``: drive sets of worlds and measure."""

import dataclasses
import json
import math
import shlex
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from navette.cli.bench_options import BenchOptions, TrialOptions
from navette.errors import InvalidValueError

if TYPE_CHECKING:
    from navette.bench.statistics import MeasureDifference, Summary
    from navette.bench.trial import Trial, TrialResult


def bench(options: BenchOptions) -> None:
    """Drive a set of worlds and measure success, contacts, time and score."""
    from navette.bench.runner import read_results, run_trials
    from navette.bench.statistics import compare, summarize

    trials = _trials(options.trials)
    results = run_trials(trials, jobs=options.jobs, results_file=options.results)
    found = _with_progress(results, trials)
    summary, against = summarize(found), []
    if options.compare is not None:
        against = compare(list(read_results(options.compare).values()), found)
    if options.report is not None:
        suite = options.trials.suite
        _write_report(options.report, suite, summary, found, against, trials)
    if options.as_json:
        click.echo(json.dumps(_plain(summary, against)))
    else:
        _print(summary, against)
    if summary.success < options.min_success:
        raise click.exceptions.Exit(1)


def _trials(options: TrialOptions) -> list["Trial"]:
    from navette.bench.suites import suite_trials

    worlds = _numbers("--worlds", options.worlds)
    base = suite_trials(
        options.suite, data=options.data, worlds=worlds, robot=options.robot
    )
    parameters = _parameters(options.param or (), options.controller, options.planner)
    return [
        dataclasses.replace(trial, seed=seed, parameters=parameters)
        for seed in _numbers("--seeds", options.seeds) or (0,)
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
