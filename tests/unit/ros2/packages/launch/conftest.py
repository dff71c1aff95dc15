"""Launches on a virtual clock with fake processes."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import pytest

from navette.ros2.packages.launch import LaunchDescription, LaunchService
from navette.ros2.packages.launch.logging import get_logger
from navette.ros2.packages.launch.running import LaunchCommand
from navette.runtime import VirtualClock
from navette.runtime.loop import EventLoop
from navette.supervisor import INTERRUPT, ProcessListener


@dataclass
class FakeProcess:
    """Process that ends on SIGINT, or only on SIGKILL if ``stubborn``."""

    command: LaunchCommand
    pid: int
    at_s: float
    stubborn: bool = False
    signals: list[tuple[float, int]] = field(default_factory=list)
    written: bytes = b""
    now_s: Callable[[], float] = lambda: 0.0
    behaviour: Callable[["FakeProcess"], None] = lambda process: None

    def watch(self, listener: ProcessListener) -> None:
        self.listener = listener
        self.behaviour(self)

    def signal(self, number: int) -> None:
        self.signals.append((self.now_s(), number))
        if not self.stubborn or number == 9:
            self.listener.exited(-number if number != INTERRUPT else 0)

    def write(self, data: bytes) -> None:
        self.written += data


class FakeRunner:
    """Records started commands.

    ``behaviour(process)`` is called for each process once it is watched.
    """

    graph = None

    def __init__(self, loop: EventLoop) -> None:
        self.loop = loop
        self.started: list[FakeProcess] = []
        self.behaviour: Callable[[FakeProcess], None] = lambda process: None
        self.closed = False

    def now_s(self) -> float:
        return self.loop.clock.now_ns / 1e9

    def start(self, command: LaunchCommand) -> FakeProcess:
        pid = 100 + len(self.started)
        process = FakeProcess(command, pid, self.now_s(), now_s=self.now_s)
        process.behaviour = self.behaviour
        self.started.append(process)
        return process

    def exit_after(self, process: FakeProcess, seconds: float, code: int) -> None:
        at_ns = self.loop.clock.now_ns + round(seconds * 1e9)
        self.loop.call_at(at_ns, lambda: process.listener.exited(code))

    def close(self) -> None:
        self.closed = True


class Launch:
    """A launch service with a fake runner."""

    def __init__(self) -> None:
        loop = EventLoop(VirtualClock())
        self.runner = FakeRunner(loop)
        self.service = LaunchService(loop=loop, runner=self.runner)
        self.context = self.service.context
        self.context.launch_configurations["sigterm_timeout"] = "5"

    def run(self, *entities: object, **arguments: str) -> int:
        self.context.launch_configurations.update(arguments)
        self.service.include_launch_description(LaunchDescription(list(entities)))  # type: ignore[arg-type]
        return self.service.run()

    @property
    def errors(self) -> str:
        return "\n".join(map(str, self.service.errors))

    @property
    def argv(self) -> list[list[str]]:
        return [process.command.words for process in self.runner.started]

    @property
    def labels(self) -> list[str]:
        return [process.command.label for process in self.runner.started]


@pytest.fixture
def launch() -> Launch:
    return Launch()


@pytest.fixture(autouse=True)
def logged(caplog: pytest.LogCaptureFixture) -> Iterator[pytest.LogCaptureFixture]:
    logger = get_logger()
    before = logger.level
    logger.setLevel("INFO")
    yield caplog
    logger.setLevel(before)
