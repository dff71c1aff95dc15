"""``navette bench``: drive sets of worlds and measure."""

import dataclasses
import json
import os
import sys
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from navette.cli.bench_options import BenchOptions, TrialOptions
from navette.errors import InvalidValueError

if TYPE_CHECKING:
    from navette.navigation.bench.report import ReportedRun
    from navette.navigation.bench.statistics import MeasureDifference
    from navette.navigation.bench.trial import Trial, TrialResult

FAILED = 1
_DECISIVE = ("success", "score")  # a faster method may come closer to obstacles


def bench(options: BenchOptions) -> None:
    """Drive a set of worlds and measure success, contacts, time and score."""
    from navette.cli.output import hanging
    from navette.navigation.bench.statistics import compare
    from navette.navigation.bench.summary_text import (
        LABEL_COLUMNS,
        comparison_text,
        plain,
        summary_text,
    )

    for file in (options.results, options.report):
        if file is not None:
            _check_writable(file)  # before hours of driving
    runs = _runs(options)
    mine = runs[-1]
    against: list[MeasureDifference] = []
    if len(runs) == 2:
        against = compare(runs[0].results, mine.results)
        if not against:
            raise InvalidValueError(
                "--compare: the results have no trial in common; the same suite, "
                "worlds and seeds are compared"
            )
    if options.report is not None:
        _write_report(options.report, options.trials.suite, runs, against)
    if options.as_json:
        click.echo(json.dumps(plain(runs, against)))
    else:
        for each in runs:
            text = summary_text(each.summary, each.name)
            click.echo(hanging(text, LABEL_COLUMNS))
        for line in mine.failures():
            click.echo(hanging(line, 2))
        click.echo(hanging(comparison_text(against), LABEL_COLUMNS), nl=False)
    worse = any(each.is_worse for each in against if each.measure in _DECISIVE)
    if mine.summary.success < options.min_success or worse:
        raise click.exceptions.Exit(FAILED)


def _check_writable(file: Path) -> None:
    folder = file.absolute().parent
    if file.is_dir() or not folder.is_dir() or not os.access(folder, os.W_OK):
        reason = (
            "is a folder; name a file"
            if file.is_dir()
            else f"folder {str(folder)!r} does not exist or cannot be written to"
        )
        raise InvalidValueError(f"{str(file)!r}: {reason}")


def _runs(options: BenchOptions) -> list["ReportedRun"]:
    """Drive or read what is compared: the baseline first, mine last."""
    from navette.navigation.bench.report import ReportedRun
    from navette.navigation.bench.runner import read_results
    from navette.navigation.bench.variants import (
        MINE,
        is_results_file,
        renamed,
        with_variant,
    )

    names = options.compare or []
    if len(names) > 2:
        raise InvalidValueError(
            f"--compare {' '.join(names)}: expected BASELINE, or BASELINE MINE"
        )
    if len(names) == 1:
        names = [*names, MINE]
    base = _trials(options.trials)
    trials: list[Trial] = []
    for name in names:
        if not is_results_file(name):
            trials += with_variant(base, name)
    if not names:
        trials = base
    found = _driven(options, trials)
    runs = []
    for name in names or [""]:
        if is_results_file(name):
            own = renamed(list(read_results(Path(name)).values()), name)
        else:
            own = [each for each in found if each.variant == name]
        if not own:
            raise InvalidValueError(f"--compare {name!r}: no results in it")
        runs.append(ReportedRun.of(name, own, trials))
    return runs


def _driven(options: BenchOptions, trials: Sequence["Trial"]) -> list["TrialResult"]:
    """Drive the trials, or read what was driven, in their order."""
    from navette.navigation.bench.runner import run_trials
    from navette.ros2.names.node_classes import node_makers

    if options.results is not None:
        _show_finished(options.results, trials)
    results = run_trials(
        trials,
        jobs=options.jobs,
        results_file=options.results,
        cluster=options.dask,
        load_nodes=node_makers,
    )
    try:
        return _with_progress(results, trials)
    except KeyboardInterrupt:
        sys.stderr.write(_continuation(options.results))
        raise


def _show_finished(file: Path, trials: Sequence["Trial"]) -> None:
    """Print how many trials a file of results contains, if there are any."""
    from navette.navigation.bench.runner import finished_trials, results_of_others

    others = results_of_others(file)
    if others:
        sys.stderr.write(
            f"{file}: results of {', '.join(others)} are not used; this is Navette "
            f"{version('navette')}. To compare with them: --compare {file}\n"
        )
    count = len(finished_trials(file, trials))
    if count:
        sys.stderr.write(f"{file}: {count} of {len(trials)} trials are done already\n")


def _continuation(results: Path | None) -> str:
    if results is None:
        return "interrupted; --results FILE keeps what was driven, to continue\n"
    return f"interrupted; the same command continues with what is in {results}\n"


def _trials(options: TrialOptions) -> list["Trial"]:
    from navette.navigation.bench.suites import suite_trials
    from navette.navigation.bench.variants import absolute_place

    worlds = _numbers("--worlds", options.worlds)
    robot = None if options.robot is None else absolute_place(options.robot)
    data = None if options.data is None else options.data.resolve()
    base = suite_trials(options.suite, data=data, worlds=worlds, robot=robot)
    if options.trials is not None and options.seeds:
        raise InvalidValueError("--trials N and --seeds: expected one of them")
    seeds = tuple(range(options.trials or 0)) or _numbers("--seeds", options.seeds)
    methods = options.methods
    replaced = {k: absolute_place(v) for k, v in methods.replacements.items()}
    return [
        dataclasses.replace(
            trial,
            seed=seed,
            parameters=methods.parameters,
            params_files=tuple(path.resolve() for path in options.params or ()),
            methods={k: absolute_place(v) for k, v in methods.chosen.items()},
            replacements=replaced,
        )
        for seed in seeds or (0,)
        for trial in base
    ]


def _numbers(option: str, text: str) -> tuple[int, ...]:
    """Return the numbers of ``1,4,7-9``."""
    numbers: list[int] = []
    for part in filter(None, text.split(",")):
        first, dash, last = part.partition("-")
        last = last if dash else first
        if not (first.isdecimal() and last.isdecimal()):
            raise InvalidValueError(f"{option} {text!r}: expected numbers as 1,4,7-9")
        if int(last) < int(first):
            raise InvalidValueError(f"{option} {text!r}: {part!r} is an empty range")
        numbers += range(int(first), int(last) + 1)
    return tuple(numbers)


def _with_progress(results: Any, trials: Sequence["Trial"]) -> list["TrialResult"]:
    """Collect the results in the order of the trials, behind a bar."""
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    found: list[TrialResult] = []
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
    )
    console = Console(stderr=True)
    with Progress(*columns, console=console, transient=True) as progress:
        task = progress.add_task("trials", total=len(trials))
        for result in results:
            found.append(result)
            failed = sum(not each.succeeded for each in found)
            progress.update(task, advance=1, description=f"trials, {failed} failed")
    order = {(t.variant, t.suite, t.name, t.seed): i for i, t in enumerate(trials)}
    return sorted(found, key=lambda r: order[r.variant, r.suite, r.name, r.seed])


def _write_report(
    file: Path,
    suite: str,
    runs: Sequence["ReportedRun"],
    against: Sequence["MeasureDifference"],
) -> None:
    from navette.navigation.bench.report import report_page

    page = report_page(f"navette bench {suite}", runs, against)
    file.write_text(page, encoding="utf-8")
    sys.stderr.write(f"report: {file}\n")
