"""What the commands do, without how it looks: bring up, wait, end, look."""

import threading
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

from navette.supervisor.client import Client
from navette.supervisor.log_book import LogLine, LogReader
from navette.supervisor.project import Project
from navette.supervisor.specs import State

LOOK_S = 0.05
_LAST_LINES = 12
_SETTLED = {State.RUNNING, State.ENDED, State.FAILED, State.STOPPED, State.PAUSING}
_TROUBLE = {State.FAILED, State.PAUSING}


@dataclass(frozen=True)
class ProcessView:
    """A process as the supervisor tells of it."""

    module: str
    name: str
    label: str
    state: State
    pid: int | None
    seconds: float
    restarts: int
    reason: str
    domain: str

    @property
    def is_settled(self) -> bool:
        return self.state in _SETTLED

    @property
    def is_in_trouble(self) -> bool:
        return self.state in _TROUBLE


def views(status: Sequence[dict[str, Any]]) -> list[ProcessView]:
    """One for each process of a status, in order."""
    return [
        ProcessView(
            **{
                **process,
                "module": module["module"],
                "state": State(process["state"]),
            }
        )
        for module in status
        for process in module["processes"]
    ]


def neighbours(own: Client, others: Sequence[Client]) -> list[tuple[str, Project]]:
    """Other projects whose nodes meet those of this one: domain and project."""
    domains = {view.domain for view in views(own.status())}
    return [
        (domain, other.project)
        for other in others
        if other.project.folder != own.project.folder
        for domain in sorted({view.domain for view in views(other.status())} & domains)
    ]


def until_settled(
    client: Client, modules: Sequence[str], timeout_s: float
) -> Iterator[list[ProcessView]]:
    """The processes of some modules, again and again until nothing is pending.

    Where one is in trouble, those that wait for it are not waited for.
    """
    pause, left_s = threading.Event(), timeout_s
    while True:
        found = [view for view in views(client.status()) if view.module in modules]
        yield found
        trouble = any(view.is_in_trouble for view in found)
        pending = [
            view
            for view in found
            if not view.is_settled and not (trouble and view.state is State.WAITING)
        ]
        if not pending or left_s <= 0:
            return
        pause.wait(LOOK_S)
        left_s -= LOOK_S


def until_down(
    client: Client,
    modules: Sequence[str] | None,
    timeout_s: float,
    first: Sequence[ProcessView] = (),
) -> Iterator[list[ProcessView]]:
    """The processes of some modules (None: all) until all of these have ended.

    Args:
        first: what there was of them; it may be gone by now.
    """
    pause, left_s = threading.Event(), timeout_s
    seen = {view.label: view for view in first}
    while True:
        here = [
            view
            for view in views(client.status())
            if modules is None or view.module in modules
        ]
        labels = {view.label for view in here}
        for label in seen.keys() - labels:
            seen[label] = replace(seen[label], state=State.STOPPED, pid=None)
        seen.update((view.label, view) for view in here)
        yield list(seen.values())
        if not here or left_s <= 0:
            return
        pause.wait(LOOK_S)
        left_s -= LOOK_S


def last_words(project: Project, view: ProcessView) -> list[str]:
    """What a process wrote last, in its newest run."""
    reader = LogReader(
        project.state,
        lambda line: (line.module, line.name) == (view.module, view.name),
    )
    lines = reader.last(200)
    reader.close()
    starts = [i for i, each in enumerate(lines) if _is_start(each)]
    newest = lines[starts[-1] :] if starts else lines
    return [each.text for each in newest if not each.event][-_LAST_LINES:]


def _is_start(line: LogLine) -> bool:
    return line.event and line.text.startswith("started")
