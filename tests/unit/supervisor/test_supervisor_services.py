"""Supervisor on a virtual clock with fake processes."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

from navette.errors import UnknownNameError
from navette.runtime import VirtualClock
from navette.runtime.loop import EventLoop
from navette.supervisor import ProcessConfig, ProcessError, RestartPolicy, ServiceConfig
from navette.supervisor.log_store import LogReader, LogStore
from navette.supervisor.supervisor import Supervisor


@dataclass
class FakeChild:
    argv: tuple[str, ...]
    pid: int
    at_s: float
    stubborn: bool = False
    signals: list[int] = field(default_factory=list)
    behaviour: Callable[["FakeChild"], None] = lambda child: None
    listener: Any = None

    def watch(self, listener: Any) -> None:
        self.listener = listener
        self.behaviour(self)

    def signal(self, number: int) -> None:
        self.signals.append(number)
        if not self.stubborn or number == 9:
            self.listener.exited(-number)


class World:
    """A supervisor with a fake process manager."""

    def __init__(self, folder: Path) -> None:
        self.loop = EventLoop(VirtualClock())
        self.children: list[FakeChild] = []
        self.behaviour: Callable[[FakeChild], None] = lambda child: None
        self.idle = 0
        self.folder = folder
        self.log = LogStore(folder, self.loop)
        self.supervisor = Supervisor(self, self.loop, self.log, on_idle=self._be_idle)  # type: ignore[arg-type]

    def start(self, argv: Any, options: Any) -> FakeChild:
        if argv[0] == "missing":
            raise ProcessError("cannot start 'missing': No such file")
        pid = 100 + len(self.children)
        child = FakeChild(argv, pid, self.loop.clock.now_ns / 1e9)
        child.behaviour = self.behaviour
        self.children.append(child)
        return child

    def _be_idle(self) -> None:
        self.idle += 1

    def run(self, seconds: float = 0.0) -> None:
        self.loop.run(until_ns=self.loop.clock.now_ns + round(seconds * 1e9))

    def exit_after(self, child: FakeChild, seconds: float, code: int) -> None:
        at_ns = self.loop.clock.now_ns + round(seconds * 1e9)
        self.loop.call_at(at_ns, lambda: child.listener.exited(code))

    @property
    def states(self) -> dict[str, str]:
        return {
            process["label"]: process["state"]
            for service in self.supervisor.status()
            for process in service["processes"]
        }

    @property
    def reasons(self) -> list[str]:
        return [
            process["reason"]
            for service in self.supervisor.status()
            for process in service["processes"]
        ]

    @property
    def log_lines(self) -> list[str]:
        reader = LogReader(self.folder)
        lines = [f"{line.label}: {line.text}" for line in reader.last(None)]
        reader.close()
        return lines


@pytest.fixture
def world(tmp_path: Path) -> Any:
    made = World(tmp_path)
    yield made
    made.log.close()


def service(
    name: str, *depends_on: str, word: str = "x", ready: bool = False, **options: Any
) -> ServiceConfig:
    process = ProcessConfig(
        service=name,
        name=name,
        argv=(word,),
        cwd=".",
        reports_ready=ready,
        restart=RestartPolicy(**options),
    )
    return ServiceConfig(name=name, depends_on=depends_on, processes=(process,))


def test_the_restart_delay_doubles_up_to_the_limit(world: Any) -> None:
    world.behaviour = lambda child: world.exit_after(child, 1.0, 3)
    world.supervisor.up([service("m", delay_s=0.5, max_attempts=3)], {})
    world.run(1.0)
    assert world.states == {"m": "restarting"}
    world.run(60)
    assert [child.at_s for child in world.children] == [0.0, 1.5, 3.5, 6.5]
    assert world.states == {"m": "failed"}
    assert world.reasons == ["exit code 3; gave up after 3 restarts"]
    assert "m: exit code 3; restart in 2 s" in world.log_lines


def test_a_long_run_resets_the_restart_count(world: Any) -> None:
    world.behaviour = lambda child: world.exit_after(child, 20.0, 1)
    world.supervisor.up([service("m", delay_s=0.5, max_attempts=1)], {})
    world.run(100)
    assert [child.at_s for child in world.children] == [0.0, 20.5, 41.0, 61.5, 82.0]


@pytest.mark.parametrize(
    ("when", "code", "state", "starts"),
    [
        ("no", 1, "failed", 1),
        ("on-failure", 0, "ended", 1),
        ("on-failure", 1, "failed", 3),
        ("always", 0, "failed", 3),
    ],
)
def test_restart_conditions(
    world: Any, when: str, code: int, state: str, starts: int
) -> None:
    world.behaviour = lambda child: world.exit_after(child, 1.0, code)
    world.supervisor.up([service("m", condition=when, max_attempts=2)], {})
    world.run(100)
    assert world.states == {"m": state}
    assert len(world.children) == starts


def test_a_service_waits_for_its_dependencies(world: Any) -> None:
    specs = [service("sim", ready=True), service("robot", "sim")]
    world.supervisor.up(specs, {})
    world.run(1.0)
    assert world.states == {"sim": "starting", "robot": "waiting"}
    assert world.reasons == ["", "for sim"]
    world.run(10.0)  # the readiness timeout
    assert world.states == {"sim": "running", "robot": "running"}


def test_dependents_stop_first(world: Any) -> None:
    specs = [service("sim"), service("robot", "sim"), service("viewer")]
    world.supervisor.up(specs, {})
    world.run()
    order: list[str] = []
    for child, name in zip(world.children, ("sim", "viewer", "robot"), strict=True):
        child.stubborn = True
        child.name = name

        def signal(number: int, child: Any = child) -> None:
            order.append(child.name)
            world.exit_after(child, 1.0, 0)

        child.signal = signal
    world.supervisor.down()
    world.run(0.5)
    assert sorted(order) == ["robot", "viewer"]
    world.run(5)
    assert order[2] == "sim"
    assert world.states == {}
    assert world.idle


def test_signals_escalate(world: Any) -> None:
    def stubborn(child: Any) -> None:
        child.stubborn = True

    world.behaviour = stubborn
    world.supervisor.up([service("m")], {})
    world.run()
    world.supervisor.down(["m"])
    world.run(20)
    assert world.children[0].signals == [2, 15, 9]
    assert "m: does not end; sending SIGKILL" in world.log_lines
    with pytest.raises(UnknownNameError, match=r"'m' is not up \(up: nothing\)"):
        world.supervisor.down(["m"])


def test_restart_uses_the_new_configuration(world: Any) -> None:
    world.supervisor.up([service("m", word="old")], {})
    world.run()
    world.supervisor.restart([service("m", word="new")], {})
    world.run()
    assert [child.argv for child in world.children] == [("old",), ("new",)]
    assert world.states == {"m": "running"}


def test_up_starts_only_what_does_not_run(world: Any) -> None:
    spec = service("m", condition="no")
    world.supervisor.up([spec], {})
    world.run()
    world.supervisor.up([spec], {})
    world.run()
    assert len(world.children) == 1
    world.children[0].listener.exited(1)
    world.run()
    assert world.states == {"m": "failed"}
    world.supervisor.up([spec], {})
    world.run()
    assert world.states == {"m": "running"}
    world.supervisor.up([service("m", word="other")], {})
    world.run()
    assert world.children[-1].argv == ("other",)


def test_down_cancels_a_pending_restart(world: Any) -> None:
    world.behaviour = lambda child: world.exit_after(child, 1.0, 1)
    world.supervisor.up([service("m", delay_s=5.0)], {})
    world.run(2.0)
    world.supervisor.down()
    world.run(100.0)
    assert len(world.children) == 1
    assert world.states == {}


def test_a_failed_start_is_a_failure(world: Any) -> None:
    world.supervisor.up([service("m", word="missing")], {})
    world.run()
    assert world.states == {"m": "failed"}
    assert world.reasons == ["cannot start 'missing': No such file"]
