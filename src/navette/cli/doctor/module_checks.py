"""Checks of the modules that ``navette up`` keeps running, of the project here."""

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from navette.cli.doctor.findings import Finding, Level, listed, plural

MODULES = "Modules"


def modules_here() -> list[dict[str, Any]]:
    """What the supervisor of this folder's project tells; empty without one."""
    from navette.supervisor.client import Client
    from navette.supervisor.project import find_project

    client = Client(find_project(Path.cwd()))
    return client.status() if client.is_there() else []


def check_modules(modules: Iterable[Mapping[str, Any]]) -> Iterator[Finding]:
    """Do the processes of all modules run, and did they run from the start?"""
    names: list[str] = []
    troubles: list[Finding] = []
    for module in modules:
        names.append(module["module"])
        for process in module["processes"]:
            troubles += _process(module["module"], process)
    yield from troubles
    if names and not troubles:
        text = f"{plural(len(names), 'module')} up: {listed(names)}"
        yield Finding(Level.GOOD, MODULES, "modules", text)


def _process(module: str, process: Mapping[str, Any]) -> Iterator[Finding]:
    advice = f"navette logs {module}"
    reason = f": {process['reason']}" if process["reason"] else ""
    if process["state"] == "failed":
        text = f"does not run{reason}"
        yield Finding(
            Level.PROBLEM, MODULES, process["label"], text, advice, dict(process)
        )
    elif process["restarts"]:
        times = plural(process["restarts"], "time")
        text = f"was started again {times}{reason}"
        yield Finding(
            Level.WARNING, MODULES, process["label"], text, advice, dict(process)
        )
