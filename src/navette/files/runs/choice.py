"""Which run a program joins: the one that is named, or the only one there is."""

import logging
import os
from collections.abc import Mapping, Sequence

from navette import __version__
from navette.errors import NetworkError
from navette.files.runs.entry import PROTOCOL, RunInfo, check_run_name
from navette.files.runs.registry import live_runs

_log = logging.getLogger(__name__)

VARIABLE = "NAVETTE_RUN"
SHARED = "shared"
"""Value of :data:`VARIABLE` for the network that all programs share."""

# Each of these selects a network explicitly.
NETWORK_VARIABLES = (
    "ROS_DOMAIN_ID",
    "NAVETTE_ROUTER",
    "NAVETTE_LISTEN",
    "NAVETTE_SECURITY",
    "NAVETTE_LOCKSTEP",
    "ZENOH_SESSION_CONFIG_URI",
    "ZENOH_ROUTER_CONFIG_URI",
    "ZENOH_CONFIG_OVERRIDE",
)


def named_run(environment: Mapping[str, str] = os.environ) -> str:
    """Return the run that ``NAVETTE_RUN`` names; empty: none, or the shared network.

    Raises:
        InvalidValueError: the value cannot be the name of a run.
    """
    name = environment.get(VARIABLE, "")
    return "" if name in ("", SHARED) else check_run_name(name)


def shares(environment: Mapping[str, str] = os.environ) -> bool:
    """Whether the environment requests the shared network."""
    name = environment.get(VARIABLE, "")
    if name:
        return name == SHARED
    return any(environment.get(variable) for variable in NETWORK_VARIABLES)


def chosen_run(
    environment: Mapping[str, str] = os.environ, *, named_only: bool = False
) -> RunInfo | None:
    """Return the run to join; None: the shared network.

    Args:
        named_only: join no run that is not named.

    Raises:
        InvalidValueError: ``NAVETTE_RUN`` cannot be the name of a run.
        NetworkError: the named run does not live, several runs do and none is named,
            or another version of Navette started the run.
    """
    name = named_run(environment)
    if not name and (named_only or shares(environment)):
        return None
    runs = live_runs()
    found = [run for run in runs if run.name == name] if name else runs
    if name and not found:
        raise NetworkError(f"no run {name!r} ({VARIABLE}, --run); {_living(runs)}")
    if len(found) > 1:
        raise NetworkError(_question(found))
    if found and not found[0].is_compatible:
        raise NetworkError(_other_version(found[0]))
    return found[0] if found else None


def every_network() -> list[str]:
    """Return what ``NAVETTE_RUN`` names: each run, and the shared network."""
    return [*(run.name for run in live_runs()), SHARED]


def stay_shared() -> None:
    """Keep this program and its children out of runs that are not named.

    For programs that are a robot, or stand for one: they must not drive another.
    """
    if os.environ.get(VARIABLE):
        return
    runs = [] if shares() else live_runs()
    os.environ[VARIABLE] = SHARED
    if runs:
        names = ", ".join(run.name for run in runs)
        _log.warning("this program does not join run %s; to join: --run NAME", names)


def pin_run() -> None:
    """Let the children of this program join the run that it joins, also later.

    Raises:
        InvalidValueError: as :func:`chosen_run`.
        NetworkError: likewise.
    """
    run = chosen_run()
    os.environ[VARIABLE] = SHARED if run is None else run.name


def _question(runs: Sequence[RunInfo]) -> str:
    rows = [(*run.row()[:-1], f"pid {run.pid}") for run in runs]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = [f"{len(runs)} runs; choose one with --run NAME:", ""]
    for row in rows:
        words = (f"{word:{width}}" for word, width in zip(row, widths, strict=True))
        lines.append(f"  {'  '.join(words)}".rstrip())
    choice = f"export {VARIABLE}={runs[0].name}"
    lines += ["", f"or for all programs of this terminal: {choice}"]
    lines.append("to stop every robot: navette stop --all")
    return "\n".join(lines)


def _living(runs: Sequence[RunInfo]) -> str:
    if not runs:
        return "no run lives: start one with navette demo or navette sim"
    return f"runs: {', '.join(run.name for run in runs)}"


def _other_version(run: RunInfo) -> str:
    return (
        f"run {run.name!r} (pid {run.pid}) was started by Navette {run.navette}, whose "
        f"run protocol is {run.protocol}; this is Navette {__version__} with protocol "
        f"{PROTOCOL}: start both with the same version, or without this run: "
        f"{VARIABLE}={SHARED}"
    )
