"""State of a launch: configurations, environment, event handlers, time.

The context is the lowest layer of this package. It refers to substitutions, entities
and event handlers by the protocols below; their classes import the context.
"""

import os
from collections import deque
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from types import SimpleNamespace
from typing import Any, Protocol

from navette.ros2.packages.launch.event import Event
from navette.ros2.packages.launch.running import Runner
from navette.ros2.packages.launch.subprocesses import SubprocessRunner
from navette.runtime import SystemClock
from navette.runtime.events import Call
from navette.runtime.loop import EventLoop


class ContextSubstitution(Protocol):
    """A substitution."""

    def perform(self, context: "LaunchContext", /) -> str: ...


class ContextEntity(Protocol):
    """A launch description entity."""

    origin: str

    def visit(self, context: "LaunchContext", /) -> "Sequence[ContextEntity] | None":
        """Do the work; return the entities to visit next."""

    def describe(self) -> str:
        """Describe the entity in an error message."""


class ContextHandler(Protocol):
    """An event handler."""

    handle_once: bool

    def matches(self, event: Event, /) -> bool: ...

    def handle(
        self, event: Event, context: "LaunchContext", /
    ) -> Sequence[ContextEntity] | None: ...

    def describe(self) -> str: ...


class LaunchContext:
    """What the actions and substitutions of a launch read and change.

    Args:
        argv: the ``name:=value`` arguments of the command.
        noninteractive: no user is at the terminal.
        loop: runs the launch's events and timers (default: a loop on the system
            clock).
        runner: starts commands (default: a process for each).

    Attributes:
        known_arguments: names of configurations that were read or declared.
        notes: state that actions of one kind share, by a name of theirs.
        busy: what keeps the launch running; without any, the launch is over.
        failed_labels: processes that ended by themselves with an error.
    """

    def __init__(
        self,
        *,
        argv: Sequence[str] | None = None,
        noninteractive: bool = False,
        loop: EventLoop | None = None,
        runner: Runner | None = None,
    ) -> None:
        self.argv = list(argv or ())
        self.noninteractive = noninteractive
        self.loop = loop or EventLoop(SystemClock())
        self.runner = runner or SubprocessRunner()
        self.is_shutdown = False
        self.launch_configurations: dict[str, str] = {}
        self.known_arguments: set[str] = set()
        self.notes: dict[str, Any] = {}
        self.events: deque[Event] = deque()
        self.busy: set[object] = set()
        self.failed_labels: list[str] = []
        self._initial_environment: dict[str, str] | None = None
        self._locals: list[dict[str, Any]] = [{}]
        self._globals: dict[str, Any] = {}
        self._configuration_stack: list[dict[str, str]] = []
        self._environment_stack: list[dict[str, str]] = []
        self._handlers: list[ContextHandler] = []
        self._name_count = 0
        self._scratch: TemporaryDirectory[str] | None = None
        self._on_close: list[Callable[[], None]] = []

    @property
    def environment(self) -> "os._Environ[str]":
        """The environment of this process, which commands inherit."""
        return os.environ

    @property
    def locals(self) -> SimpleNamespace:
        """Values of the present scope (an include, an event handler)."""
        return SimpleNamespace(**self.get_locals_as_dict())

    def get_locals_as_dict(self) -> dict[str, Any]:
        return {**self._globals, **self._locals[-1]}

    def extend_locals(self, values: Mapping[str, Any]) -> None:
        self._locals[-1].update(values)

    def extend_globals(self, values: Mapping[str, Any]) -> None:
        self._globals.update(values)

    def push_locals(self) -> None:
        self._locals.append(dict(self._locals[-1]))

    def pop_locals(self) -> None:
        self._locals.pop()

    @property
    def launch_file(self) -> Path | None:
        """The launch file that is read or run."""
        path = self._locals[-1].get("current_launch_file_path")
        return None if path is None else Path(path)

    def perform_substitution(
        self, value: str | ContextSubstitution | Iterable[str | ContextSubstitution]
    ) -> str:
        """Return the text of a substitution, or of several, joined."""
        if isinstance(value, str):
            return value
        if isinstance(value, Iterable):
            return "".join(self.perform_substitution(part) for part in value)
        return value.perform(self)

    def unique_name(self, base: str) -> str:
        """Return ``base-1``, ``base-2``, …, counted over all names of the launch."""
        self._name_count += 1
        return f"{base}-{self._name_count}"

    def scratch_folder(self) -> Path:
        """Return a folder that is deleted at the end of the launch."""
        if self._scratch is None:
            self._scratch = TemporaryDirectory(prefix="navette_launch_")
        return Path(self._scratch.name)

    def on_close(self, function: Callable[[], None]) -> None:
        """Call ``function`` at the end of the launch."""
        self._on_close.append(function)

    def close(self) -> None:
        """Restore the environment, call the registered functions, delete files."""
        self.reset_environment()
        for function in self._on_close:
            function()
        if self._scratch is not None:
            self._scratch.cleanup()

    def push_launch_configurations(self) -> None:
        self._configuration_stack.append(dict(self.launch_configurations))

    def pop_launch_configurations(self) -> None:
        kept = self._configuration_stack.pop()
        self.launch_configurations.clear()
        self.launch_configurations.update(kept)

    def push_environment(self) -> None:
        self._environment_stack.append(dict(os.environ))

    def pop_environment(self) -> None:
        _set_environment(self._environment_stack.pop())

    def save_environment(self) -> None:
        """Store the environment at the start of the launch."""
        self._initial_environment = dict(os.environ)

    def reset_environment(self) -> None:
        """Restore the environment of the launch's start."""
        if self._initial_environment is not None:
            _set_environment(self._initial_environment)

    def emit_event(self, event: Event) -> None:
        """Queue an event; it is handled after the present entity."""
        self.events.append(event)

    def emit_event_sync(self, event: Event) -> None:
        self.emit_event(event)

    def emit_from_thread(self, event: Event) -> None:
        """Queue an event from any thread."""
        self.loop.call_soon_threadsafe(lambda: self.emit_event(event), "launch")

    def call_after(self, seconds: float, function: Any, source: str) -> Call:
        """Call ``function`` after ``seconds``; cancel with ``.cancel()``."""
        at_ns = self.loop.clock.now_ns + round(seconds * 1e9)
        return self.loop.call_at(at_ns, function, source)

    def visit_later(self, entities: Iterable[ContextEntity]) -> None:
        """Queue a visit of entities in the present scope."""
        self.emit_event(VisitEvent(list(entities), dict(self._locals[-1])))

    def register_event_handler(
        self, handler: ContextHandler, append: bool = False
    ) -> None:
        """Add a handler; the newest is called first, unless appended."""
        self._handlers.insert(len(self._handlers) if append else 0, handler)

    def unregister_event_handler(self, handler: ContextHandler) -> None:
        """Remove a handler.

        Raises:
            ValueError: it is not registered, as in ROS 2.
        """
        self._handlers.remove(handler)

    @property
    def event_handlers(self) -> tuple[ContextHandler, ...]:
        return tuple(self._handlers)

    def is_registered(self, handler: ContextHandler) -> bool:
        return handler in self._handlers


class VisitEvent(Event):
    """A queued visit of entities, with the scope they were found in."""

    name = "navette.launch.Visit"

    def __init__(self, entities: list[ContextEntity], scope: dict[str, Any]) -> None:
        self.entities = entities
        self.scope = scope


def _set_environment(environment: Mapping[str, str]) -> None:
    for name in set(os.environ) - set(environment):
        del os.environ[name]
    os.environ.update(environment)
