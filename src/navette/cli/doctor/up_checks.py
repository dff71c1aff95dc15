"""Checks of the services that ``navette up`` started in this folder's project."""

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from navette.cli.doctor.findings import Diagnosis, Rating, listed, plural

SECTION = "Supervised services"


def services_here() -> list[dict[str, Any]]:
    """Return the services of this folder's supervisor; empty without one."""
    from navette.supervisor.client import SupervisorClient
    from navette.supervisor.project import find_project

    client = SupervisorClient(find_project(Path.cwd()))
    return client.status() if client.is_reachable() else []


def check_supervised(services: Iterable[Mapping[str, Any]]) -> Iterator[Diagnosis]:
    """Report processes that failed or were restarted."""
    names: list[str] = []
    problems: list[Diagnosis] = []
    for service in services:
        names.append(service["service"])
        for process in service["processes"]:
            problems += _check_process(service["service"], process)
    yield from problems
    if names and not problems:
        text = f"{plural(len(names), 'service')} up: {listed(names)}"
        yield Diagnosis(Rating.GOOD, SECTION, "services", text)


def _check_process(service: str, process: Mapping[str, Any]) -> Iterator[Diagnosis]:
    advice = f"navette logs {service}"
    label, reason = process["label"], process["reason"]
    suffix = f": {reason}" if reason else ""
    if process["state"] == "failed":
        text = f"not running{suffix}"
        yield Diagnosis(Rating.PROBLEM, SECTION, label, text, advice, dict(process))
    elif process["restarts"]:
        text = f"restarted {plural(process['restarts'], 'time')}{suffix}"
        yield Diagnosis(Rating.WARNING, SECTION, label, text, advice, dict(process))
