"""The state of a launch: configurations, environment, event handlers, time."""

import os
from collections import deque
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from types import SimpleNamespace
from typing import Any

from navette.ros2.packages.launch.event import Event
from navette.ros2.packages.launch.event_handler import EventHandler
from navette.ros2.packages.launch.launch_description_entity import (
    LaunchDescriptionEntity,
)
from navette.ros2.packages.launch.running import Runner
from navette.ros2.packages.launch.substitution import (
    Substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from navette.runtime.events import Call
from navette.runtime.loop import EventLoop


class LaunchContext:
    """What actions and substitutions of one launch see and change.

    Args:
        argv: the ``name:=value`` arguments of the command.
        noninteractive: nobody is at the terminal.
        loop: runs the launch's events and timers.
        runner: starts commands.
    """

    def __init__(
        self,
        *,
        argv: Sequence[str] | None = None,
        noninteractive: bool = False,
        loop: EventLoop,
        runner: Runner,
    ) -> None:
        self.argv = list(argv or ())
        self.noninteractive = noninteractive
        self.loop = loop
        self.runner = runner
        self.is_shutdown = False
        self.launch_configurations: dict[str, str] = {}
        #: Names of configurations that were looked up or declared.
        self.known_arguments: set[str] = set()
        #: What actions of one kind remember, by the kind's name.
        self.notes: dict[str, Any] = {}
        self.events: deque[Event] = deque()
        #: What the launch waits for: while there is any, it is not over.
        self.busy: set[object] = set()
        self.failed_labels: list[str] = []
        self._locals: list[dict[str, Any]] = [{}]
        self._globals: dict[str, Any] = {}
        self._configuration_stack: list[dict[str, str]] = []
        self._environment_stack: list[dict[str, str]] = []
        self._handlers: list[EventHandler] = []
        self._count = 0
        self._scratch: TemporaryDirectory[str] | None = None
        self._on_close: list[Callable[[], None]] = []

    # -- values ------------------------------------------------------------------

    @property
    def environment(self) -> "os._Environ[str]":
        """The environment of this process, which the launch's commands inherit."""
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
        """The launch file that is being read or run."""
        path = self._locals[-1].get("current_launch_file_path")
        return None if path is None else Path(path)

    def perform_substitution(
        self, value: Substitution | str | Iterable[Substitution | str]
    ) -> str:
        """The text of substitutions."""
        return perform_substitutions(self, normalize_to_list_of_substitutions(value))

    def unique_name(self, base: str) -> str:
        """``base-1``, ``base-2``, … counted over all names of this launch."""
        self._count += 1
        return f"{base}-{self._count}"

    def scratch_folder(self) -> Path:
        """A folder for files that are gone with the launch."""
        if self._scratch is None:
            self._scratch = TemporaryDirectory(prefix="navette_launch_")
        return Path(self._scratch.name)

    def on_close(self, function: Callable[[], None]) -> None:
        """Call ``function`` when the launch is over."""
        self._on_close.append(function)

    def close(self) -> None:
        """Let go of what was made for the launch, and take the scratch folder away."""
        for function in self._on_close:
            function()
        if self._scratch is not None:
            self._scratch.cleanup()

    # -- scopes ------------------------------------------------------------------

    def push_launch_configurations(self) -> None:
        self._configuration_stack.append(dict(self.launch_configurations))

    def pop_launch_configurations(self) -> None:
        kept = self._configuration_stack.pop()
        self.launch_configurations.clear()
        self.launch_configurations.update(kept)

    def push_environment(self) -> None:
        self._environment_stack.append(dict(os.environ))

    def pop_environment(self) -> None:
        self.restore_environment(self._environment_stack.pop())

    def reset_environment(self) -> None:
        """Back to how it was when the launch started."""
        first = self.notes.get("first environment")
        if first is not None:
            self.restore_environment(first)

    @staticmethod
    def restore_environment(kept: Mapping[str, str]) -> None:
        """Make the environment be ``kept`` and nothing else."""
        for name in set(os.environ) - set(kept):
            del os.environ[name]
        os.environ.update(kept)

    # -- events ------------------------------------------------------------------

    def emit_event(self, event: Event) -> None:
        """Let the handlers have it, after what is being visited now."""
        self.events.append(event)

    def emit_event_sync(self, event: Event) -> None:
        self.emit_event(event)

    def emit_from_thread(self, event: Event) -> None:
        """As :meth:`emit_event`, from any thread."""
        self.loop.call_soon_threadsafe(lambda: self.emit_event(event), "launch")

    def call_after(self, seconds: float, function: Any, source: str) -> Call:
        """Call ``function`` once ``seconds`` have passed; cancel with ``.cancel()``."""
        at_ns = self.loop.clock.now_ns + round(seconds * 1e9)
        return self.loop.call_at(at_ns, function, source)

    def visit_later(self, entities: Iterable[LaunchDescriptionEntity]) -> None:
        """Let entities be visited after what is being visited now."""
        self.emit_event(VisitEvent(list(entities), dict(self._locals[-1])))

    def register_event_handler(
        self, handler: EventHandler, append: bool = False
    ) -> None:
        """The newest handler is asked first, unless appended."""
        if append:
            self._handlers.append(handler)
        else:
            self._handlers.insert(0, handler)

    def unregister_event_handler(self, handler: EventHandler) -> None:
        """Raises ValueError where it is not registered, as ROS 2's does."""
        self._handlers.remove(handler)

    @property
    def event_handlers(self) -> tuple[EventHandler, ...]:
        return tuple(self._handlers)

    def is_registered(self, handler: EventHandler) -> bool:
        return handler in self._handlers


class VisitEvent(Event):
    """Entities to be visited, with the locals they were found with."""

    name = "navette.navigation.stack.Visit"

    def __init__(
        self, entities: list[LaunchDescriptionEntity], scope: dict[str, Any]
    ) -> None:
        self.entities = entities
        self.scope = scope
