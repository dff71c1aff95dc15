"""State of a launch: configurations, environment, event handlers, time.

The context is the lowest layer of this package. It refers to substitutions, entities
and event handlers by the protocols below; their classes import the context.
"""

import asyncio
import os
import queue
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Protocol

from navette.ros2.packages.launch.errors import LaunchError
from navette.ros2.packages.launch.event import Event
from navette.ros2.packages.launch.running import Runner
from navette.ros2.packages.launch.subprocesses import SubprocessRunner
from navette.runtime import SystemClock
from navette.runtime.events import Call
from navette.runtime.loop import EventLoop

#: Location of a description that a program made.
SCRIPT = "<script>"


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

    def get_asyncio_future(self) -> "asyncio.Future[Any] | None":
        """Return what the launch waits for."""


class ContextHandler(Protocol):
    """An event handler."""

    handle_once: bool

    def matches(self, event: Event, /) -> bool: ...

    def handle(self, event: Event, context: "LaunchContext", /) -> Any: ...

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
        make_asyncio_loop: set by the service while it runs.
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
        self.launch_configurations: dict[str, Any] = {}
        self.known_arguments: set[str] = set()
        self.notes: dict[str, Any] = {}
        self._event_queue: queue.SimpleQueue[Event] = queue.SimpleQueue()
        self.busy: set[object] = set()
        self.failed_labels: list[str] = []
        self._initial_environment = dict(os.environ)
        self._locals: list[dict[str, Any]] = [{}]
        self._globals: dict[str, Any] = {}
        self._configuration_stack: list[dict[str, Any]] = []
        self._environment_stack: list[dict[str, str]] = []
        self._event_handlers: list[ContextHandler] = []
        self._asyncio_loop: asyncio.AbstractEventLoop | None = None
        self.make_asyncio_loop: Callable[[], asyncio.AbstractEventLoop] | None = None
        self._name_count = 0
        self._scratch: TemporaryDirectory[str] | None = None
        self._on_close: list[Callable[[], None]] = []

    @property
    def environment(self) -> "os._Environ[str]":
        """The environment of this process, which commands inherit."""
        return os.environ

    @property
    def asyncio_loop(self) -> asyncio.AbstractEventLoop | None:
        """Loop for coroutines of actions while the launch runs, else None."""
        if self._asyncio_loop is None and self.make_asyncio_loop is not None:
            self._asyncio_loop = self.make_asyncio_loop()
        return self._asyncio_loop

    def _set_asyncio_loop(self, loop: asyncio.AbstractEventLoop | None) -> None:
        self._asyncio_loop = loop

    @property
    def locals(self) -> "LaunchLocals":
        """Values of the present scope (an include, an event handler)."""
        return LaunchLocals(self.get_locals_as_dict())

    def get_locals_as_dict(self) -> dict[str, Any]:
        return {**self._globals, **self._locals[-1]}

    def extend_locals(self, values: Mapping[str, Any]) -> None:
        self._locals[-1].update(values)

    def extend_globals(self, values: Mapping[str, Any]) -> None:
        self._globals.update(values)

    def _push_locals(self) -> None:
        self._locals.append(dict(self._locals[-1]))

    def _pop_locals(self) -> None:
        if len(self._locals) == 1:
            raise LaunchError("the scope of locals ends more often than it begins")
        self._locals.pop()

    @property
    def launch_file(self) -> Path | None:
        """The launch file that is read or run."""
        path = self._locals[-1].get("current_launch_file_path")
        return None if path in (None, SCRIPT) else Path(path)

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
        self._reset_environment()
        for function in self._on_close:
            function()
        if self._scratch is not None:
            self._scratch.cleanup()

    def _push_launch_configurations(self) -> None:
        self._configuration_stack.append(dict(self.launch_configurations))

    def _pop_launch_configurations(self) -> None:
        if not self._configuration_stack:
            raise LaunchError(
                "the scope of configurations ends more often than it begins"
            )
        kept = self._configuration_stack.pop()
        self.launch_configurations.clear()
        self.launch_configurations.update(kept)

    def _push_environment(self) -> None:
        self._environment_stack.append(dict(os.environ))

    def _pop_environment(self) -> None:
        if not self._environment_stack:
            raise LaunchError("the scope of variables ends more often than it begins")
        _set_environment(self._environment_stack.pop())

    def save_environment(self) -> None:
        """Store the environment at the start of the launch."""
        self._initial_environment = dict(os.environ)

    def _reset_environment(self) -> None:
        """Restore the environment of the launch's start."""
        _set_environment(self._initial_environment)

    def emit_event_sync(self, event: Event) -> None:
        """Queue an event; it is handled after the present entity."""
        self._event_queue.put(event)

    async def emit_event(self, event: Event) -> None:
        """Queue an event, in a coroutine of an action."""
        self.emit_event_sync(event)

    def has_events(self) -> bool:
        return not self._event_queue.empty()

    def next_event(self) -> Event:
        """Remove and return the oldest queued event; there must be one."""
        return self._event_queue.get_nowait()

    def clear_events(self) -> None:
        while self.has_events():
            self.next_event()

    def emit_from_thread(self, event: Event) -> None:
        """Queue an event from any thread."""
        self.emit_event_sync(event)
        self.loop.call_soon_threadsafe(lambda: None, "launch")

    def call_after(self, seconds: float, function: Any, source: str) -> Call:
        """Call ``function`` after ``seconds``; cancel with ``.cancel()``."""
        at_ns = self.loop.clock.now_ns + round(seconds * 1e9)
        return self.loop.call_at(at_ns, function, source)

    def visit_later(self, entities: Iterable[ContextEntity]) -> None:
        """Queue a visit of entities in the present scope."""
        self.emit_event_sync(VisitEvent(list(entities), dict(self._locals[-1])))

    def register_event_handler(
        self, handler: ContextHandler, append: bool = False
    ) -> None:
        """Add a handler; the newest is called first, unless appended."""
        self._event_handlers.insert(len(self._event_handlers) if append else 0, handler)

    def unregister_event_handler(self, handler: ContextHandler) -> None:
        """Remove a handler.

        Raises:
            ValueError: it is not registered, as in ROS 2.
        """
        self._event_handlers.remove(handler)

    @property
    def event_handlers(self) -> tuple[ContextHandler, ...]:
        return tuple(self._event_handlers)

    def is_registered(self, handler: ContextHandler) -> bool:
        return handler in self._event_handlers


class LaunchLocals:
    """Values of a scope, as attributes that cannot be changed."""

    def __init__(self, values: Mapping[str, Any]) -> None:
        vars(self).update(values)

    def __getattr__(self, name: str) -> Any:
        known = ", ".join(vars(self)) or "none"
        raise AttributeError(f"no local {name!r} in this scope; known: {known}")

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError(
            f"local {name!r} cannot be set here; use context.extend_locals()"
        )


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
