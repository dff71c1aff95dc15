"""Run trials on all cores; finished ones are kept in a file and not run again."""

import dataclasses
import hashlib
import json
import multiprocessing
import signal
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

from navette.errors import FileFormatError
from navette.navigation.bench.trial import Trial, TrialResult

if TYPE_CHECKING:
    from navette.navigation.bench.run import NodeLoader

_START = '{"key": "'  # of each line of a results file


def run_trials(
    trials: Sequence[Trial],
    *,
    jobs: int,
    results_file: Path | None = None,
    cluster: str | None = None,
    load_nodes: "NodeLoader | None" = None,
) -> Iterator[TrialResult]:
    """Yield the result of every trial, finished ones of the file first.

    Args:
        trials: what to run.
        jobs: number of processes.
        results_file: one JSON object per line; results are appended as they arrive,
            so that an interrupted benchmark continues.
        cluster: address of a Dask scheduler, whose workers run the trials.
        load_nodes: required for trials that replace nodes of the stack.

    Raises:
        FileFormatError: the file has other content.
        NavetteError: invalid world, robot or parameter of a trial.
    """
    finished = {} if results_file is None else finished_trials(results_file, trials)
    if results_file is not None and results_file.exists():
        _end_last_line(results_file)
    waiting = []
    for trial in trials:
        result = finished.get(trial_key(trial))
        if result is None:
            waiting.append(trial)
        else:
            yield dataclasses.replace(result, variant=trial.variant)
    for trial, result in _run(waiting, jobs, cluster, load_nodes):
        if results_file is not None:
            row = {
                "key": trial_key(trial),
                "navette": version("navette"),
                **dataclasses.asdict(result),
            }
            with results_file.open("a", encoding="utf-8") as file:
                file.write(json.dumps(row) + "\n")
        yield result


def _run(
    trials: Sequence[Trial],
    jobs: int,
    cluster: str | None,
    load_nodes: "NodeLoader | None",
) -> Iterator[tuple[Trial, TrialResult]]:
    if not trials:
        return
    if cluster is not None:
        from navette.navigation.bench.cluster import run_on_cluster

        yield from run_on_cluster(trials, cluster, load_nodes)
        return
    from navette.navigation.bench.run import run_trial

    if jobs == 1 or len(trials) <= 1:
        for trial in trials:
            yield trial, run_trial(trial, load_nodes)
        return
    context = multiprocessing.get_context("forkserver")
    # A worker that Ctrl-C interrupts while it holds the lock of the queue would block
    # the others: workers ignore it, and are ended here.
    ignored = (signal.SIGINT, signal.SIG_IGN)
    with ProcessPoolExecutor(jobs, context, signal.signal, ignored) as pool:
        running = {pool.submit(run_trial, each, load_nodes): each for each in trials}
        try:
            for future in as_completed(running):
                yield running[future], future.result()
        except BaseException:
            for worker in multiprocessing.active_children():
                worker.terminate()
            raise


def trial_key(trial: Trial) -> str:
    """Return a name of the trial that changes with its values and its files.

    The name of the variant does not change it: the drive is the same.
    """
    values = dataclasses.asdict(dataclasses.replace(trial, variant=""))
    text = json.dumps(values, sort_keys=True, default=str)
    text += "".join(_digest(file) for file in _files_of(trial))
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def _files_of(trial: Trial) -> list[Path]:
    """Return the files that determine a trial."""
    names = [
        *trial.methods.values(),
        *trial.replacements.values(),
        trial.world,
        trial.robot or "",
        *map(str, trial.params_files),
    ]
    paths = [Path(part) for name in names for part in (name, name.rpartition(":")[0])]
    return [path for path in paths if path.suffix and path.is_file()]


def _digest(file: Path) -> str:
    return hashlib.sha256(file.read_bytes()).hexdigest()


def finished_trials(file: Path, trials: Sequence[Trial]) -> dict[str, TrialResult]:
    """Return key → result of the trials that this version of Navette has driven.

    Raises:
        FileFormatError: a line is not a result; names file and line.
    """
    keys = {trial_key(trial) for trial in trials}
    own = version("navette")
    return {key: result for key, by, result in _rows(file) if key in keys and by == own}


def results_of_others(file: Path) -> list[str]:
    """Return the other versions of Navette, in words, that results are of.

    Raises:
        FileFormatError: a line is not a result; names file and line.
    """
    found = {by for _, by, _ in _rows(file)} - {version("navette")}
    return [f"Navette {by}" if by else "an unnamed version" for by in sorted(found)]


def read_results(file: Path) -> dict[str, TrialResult]:
    """Return key → result of a results file, of any version; empty without a file.

    Raises:
        FileFormatError: a line is not a result; names file and line.
    """
    return {key: result for key, _, result in _rows(file)}


def _rows(file: Path) -> Iterator[tuple[str, str, TrialResult]]:
    """Yield key, version of Navette and result of each line."""
    if not file.exists():
        return
    try:
        lines = file.read_text(encoding="utf-8").splitlines(keepends=True)
    except UnicodeDecodeError as error:
        raise FileFormatError(file, _fault("", error)) from error
    for number, line in enumerate(lines, 1):
        by = ""
        try:
            row: dict[str, Any] = json.loads(line)
            key, by = str(row.pop("key")), str(row.pop("navette", ""))
            yield key, by, TrialResult(**row)
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            if not _is_partial(line):
                raise FileFormatError(file, _fault(by, error), number) from error


def _fault(by: str, error: Exception) -> str:
    own = version("navette")
    if by and by != own:
        return (
            f"a result of Navette {by}, which has other measures than this version, "
            f"{own}; drive the trials again with --results of another file"
        )
    return f"not a result of navette bench ({error})"


def _is_partial(line: str) -> bool:
    """Whether the program was killed while it wrote this line of a result."""
    return line.startswith(_START) and not line.endswith("\n") and not _is_json(line)


def _is_json(line: str) -> bool:
    try:
        json.loads(line)
    except ValueError:
        return False
    return True


def _end_last_line(file: Path) -> None:
    """Cut off a partial last line, so that a result can be appended."""
    content = file.read_text(encoding="utf-8")
    *_, last = ["", *content.splitlines(keepends=True)]
    if _is_partial(last):
        file.write_text(content.removesuffix(last), encoding="utf-8")
    elif last and not last.endswith("\n"):
        file.write_text(f"{content}\n", encoding="utf-8")
