"""What is to run: modules and their processes, with everything worked out.

Made from ``navette.yaml`` by the command, sent to the supervisor as JSON.
"""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from enum import Enum
from typing import Any

POLICIES = ("no", "on-failure", "always")


class State(Enum):
    """Of a process; the values are what people and programs read."""

    WAITING = "waiting"  # for the modules it needs
    STARTING = "starting"
    RUNNING = "running"
    PAUSING = "restarting"  # before its next restart
    STOPPING = "stopping"
    STOPPED = "stopped"  # because it was asked to
    ENDED = "ended"  # by itself, with exit code 0
    FAILED = "failed"


ALIVE = (State.STARTING, State.RUNNING, State.STOPPING)


@dataclass(frozen=True, kw_only=True)
class RestartPolicy:
    """Whether a process that ended by itself is started again.

    The first time after ``delay_s``, then after twice that, and so on up to
    ``longest_delay_s``; after ``limit`` restarts in a row it is given up. A process
    that ran for ``good_s`` begins anew.
    """

    when: str = "on-failure"
    delay_s: float = 0.5
    longest_delay_s: float = 30.0
    limit: int = 5
    good_s: float = 10.0

    def wants(self, code: int) -> bool:
        """Whether an end with this exit code calls for a restart."""
        return self.when == "always" or (self.when == "on-failure" and code != 0)

    def delay_before(self, restart: int) -> float:
        """Seconds before the restart of that number in a row, from 0."""
        return min(self.delay_s * 2.0 ** min(restart, 32), self.longest_delay_s)


@dataclass(frozen=True, kw_only=True)
class ProcessSpec:
    """A process of a module.

    ``env`` is what it finds beside the environment of whoever said ``navette up``.
    ``tells_ready``: it says by itself when its nodes are up; another is ready at once.
    """

    module: str
    name: str
    words: tuple[str, ...]
    cwd: str
    env: Mapping[str, str] = field(default_factory=dict)
    shell: bool = False
    tells_ready: bool = False
    stop_timeout_s: float = 5.0
    restart: RestartPolicy = RestartPolicy()

    @property
    def label(self) -> str:
        """``robot/planner``; the module's name alone where both are the same."""
        return self.name if self.name == self.module else f"{self.module}/{self.name}"


@dataclass(frozen=True, kw_only=True)
class ModuleSpec:
    """Processes that are started and ended together.

    It starts once the modules it ``needs`` are ready. ``watched``: files and folders
    whose change means a restart where that is asked for.
    """

    name: str
    needs: tuple[str, ...] = ()
    processes: tuple[ProcessSpec, ...] = ()
    watched: tuple[str, ...] = ()

    def to_json(self) -> dict[str, Any]:
        return asdict(self)

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> "ModuleSpec":
        """What :meth:`to_json` gave, after it was JSON."""
        processes = tuple(
            ProcessSpec(
                **{
                    **each,
                    "words": tuple(each["words"]),
                    "restart": RestartPolicy(**each["restart"]),
                }
            )
            for each in data["processes"]
        )
        return cls(
            name=data["name"],
            needs=tuple(data["needs"]),
            processes=processes,
            watched=tuple(data["watched"]),
        )
