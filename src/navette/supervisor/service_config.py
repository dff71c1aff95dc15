"""Services and their processes, fully resolved.

``navette up`` creates them from ``navette.yaml`` and sends them to the supervisor.
"""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from enum import Enum
from typing import Any

RESTART_CONDITIONS = ("no", "on-failure", "always")


class ProcessState(Enum):
    """State of a managed process; the values appear in ``navette ps``."""

    WAITING = "waiting"  # for the services it depends on
    STARTING = "starting"  # not ready yet
    RUNNING = "running"
    RESTARTING = "restarting"  # waits for its next start
    STOPPING = "stopping"
    STOPPED = "stopped"  # on request
    ENDED = "ended"  # by itself, with exit code 0
    FAILED = "failed"


ALIVE = (ProcessState.STARTING, ProcessState.RUNNING, ProcessState.STOPPING)


@dataclass(frozen=True, kw_only=True)
class RestartPolicy:
    """When a process that ended by itself is started again.

    The delay doubles with each restart in a row, from ``delay_s`` to ``max_delay_s``.

    Attributes:
        condition: ``no``, ``on-failure`` or ``always``.
        max_attempts: restarts in a row before the process counts as failed.
        window_s: a run of at least this length resets the count and the delay.
    """

    condition: str = "on-failure"
    delay_s: float = 0.5
    max_delay_s: float = 30.0
    max_attempts: int = 5
    window_s: float = 10.0

    def applies_to(self, code: int) -> bool:
        """Return whether an exit with this code requires a restart."""
        return self.condition == "always" or (
            self.condition == "on-failure" and code != 0
        )

    def delay_before(self, attempt: int) -> float:
        """Return the delay before a restart, in seconds; ``attempt`` counts from 0."""
        return min(self.delay_s * 2.0 ** min(attempt, 32), self.max_delay_s)


@dataclass(frozen=True, kw_only=True)
class ProcessConfig:
    """A process of a service.

    Attributes:
        env: added to the environment of the ``navette up`` command.
        reports_ready: the process reports when its nodes spin; another process is
            ready as soon as it has started.
    """

    service: str
    name: str
    argv: tuple[str, ...]
    cwd: str
    env: Mapping[str, str] = field(default_factory=dict)
    shell: bool = False
    reports_ready: bool = False
    stop_timeout_s: float = 5.0
    restart: RestartPolicy = RestartPolicy()

    @property
    def label(self) -> str:
        """``robot/planner``; the service's name alone if the process has the same."""
        return process_label(self.service, self.name)


def process_label(service: str, name: str) -> str:
    return name if name == service else f"{service}/{name}"


@dataclass(frozen=True, kw_only=True)
class ServiceConfig:
    """Processes that are started and stopped together.

    Attributes:
        depends_on: services that must be ready first.
        watched: files and folders whose change restarts the service under ``--watch``.
    """

    name: str
    depends_on: tuple[str, ...] = ()
    processes: tuple[ProcessConfig, ...] = ()
    watched: tuple[str, ...] = ()

    def to_json(self) -> dict[str, Any]:
        return asdict(self)

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> "ServiceConfig":
        """Restore what :meth:`to_json` returned, after it was JSON."""
        processes = tuple(
            ProcessConfig(
                **{
                    **each,
                    "argv": tuple(each["argv"]),
                    "restart": RestartPolicy(**each["restart"]),
                }
            )
            for each in data["processes"]
        )
        return cls(
            name=data["name"],
            depends_on=tuple(data["depends_on"]),
            processes=processes,
            watched=tuple(data["watched"]),
        )
