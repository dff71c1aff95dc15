"""Status of a project's processes, and waiting for a change of it."""

import threading
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

from navette.supervisor.client import SupervisorClient
from navette.supervisor.log_store import LogLine, LogReader
from navette.supervisor.project import Project
from navette.supervisor.service_config import ProcessState

_POLL_S = 0.05
_LAST_LINES = 12
_TROUBLE = {ProcessState.FAILED, ProcessState.RESTARTING}
_SETTLED = _TROUBLE | {ProcessState.RUNNING, ProcessState.ENDED, ProcessState.STOPPED}


@dataclass(frozen=True)
class ProcessStatus:
    """Status of a process as the supervisor reports it.

    Attributes:
        seconds: time in this state.
        domain: the ROS domain of its nodes.
    """

    service: str
    name: str
    label: str
    state: ProcessState
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


def process_statuses(services: Sequence[dict[str, Any]]) -> list[ProcessStatus]:
    """Return the status of each process of services, in order."""
    return [
        ProcessStatus(
            **{
                **process,
                "service": service["service"],
                "state": ProcessState(process["state"]),
            }
        )
        for service in services
        for process in service["processes"]
    ]


def projects_in_same_domain(
    own: SupervisorClient, others: Sequence[SupervisorClient]
) -> list[tuple[str, Project]]:
    """Return the domains shared with other projects, and these projects."""
    domains = {each.domain for each in process_statuses(own.status())}
    return [
        (domain, other.project)
        for other in others
        if other.project.folder != own.project.folder
        for domain in sorted(
            {each.domain for each in process_statuses(other.status())} & domains
        )
    ]


def until_settled(
    client: SupervisorClient, services: Sequence[str], timeout_s: float
) -> Iterator[list[ProcessStatus]]:
    """Yield the processes of some services repeatedly until none is pending.

    Once a process is in trouble, processes that wait for dependencies do not count.
    """
    pause, left_s = threading.Event(), timeout_s
    while True:
        found = [s for s in process_statuses(client.status()) if s.service in services]
        yield found
        trouble = any(each.is_in_trouble for each in found)
        pending = [
            each
            for each in found
            if not each.is_settled
            and not (trouble and each.state is ProcessState.WAITING)
        ]
        if not pending or left_s <= 0:
            return
        pause.wait(_POLL_S)
        left_s -= _POLL_S


def until_down(
    client: SupervisorClient,
    services: Sequence[str] | None,
    timeout_s: float,
    initial: Sequence[ProcessStatus] = (),
) -> Iterator[list[ProcessStatus]]:
    """Yield the processes of some services (None: all) until all have stopped.

    Args:
        initial: their earlier status; some may have stopped since.
    """
    pause, left_s = threading.Event(), timeout_s
    seen = {each.label: each for each in initial}
    while True:
        present = {
            each.label: each
            for each in process_statuses(client.status())
            if services is None or each.service in services
        }
        for label in seen.keys() - present.keys():
            seen[label] = replace(seen[label], state=ProcessState.STOPPED, pid=None)
        seen.update(present)
        yield list(seen.values())
        if not present or left_s <= 0:
            return
        pause.wait(_POLL_S)
        left_s -= _POLL_S


def last_output(project: Project, process: ProcessStatus) -> list[str]:
    """Return the last lines that the newest run of a process wrote."""
    reader = LogReader(
        project.state,
        accept=lambda line: (
            (line.service, line.name) == (process.service, process.name)
        ),
    )
    lines = reader.last(200)
    reader.close()
    starts = [number for number, line in enumerate(lines) if _is_start(line)]
    newest = lines[starts[-1] :] if starts else lines
    return [line.text for line in newest if not line.event][-_LAST_LINES:]


def _is_start(line: LogLine) -> bool:
    return line.event and line.text.startswith("started")
