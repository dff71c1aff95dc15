"""A context: one graph, one loop, one set of arguments; tests make their own."""

import logging
import os
import sys
import threading
from collections.abc import Callable, Sequence
from contextvars import ContextVar
from types import TracebackType
from typing import TYPE_CHECKING, Any
from weakref import WeakSet

from navette.errors import InvalidValueError
from navette.runtime.arguments import RosArguments, parse_ros_arguments
from navette.runtime.clock import ContextClock
from navette.runtime.exceptions import RCLError
from navette.runtime.graph import Graph
from navette.runtime.handles import Handle
from navette.runtime.lockstep import LockStepClock, clock_of_environment
from navette.runtime.log import LogHub, StdlibHandler
from navette.runtime.log_levels import LoggingSeverity
from navette.runtime.log_sinks import ConsoleSink, FileSink
from navette.runtime.loop import EventLoop
from navette.runtime.network import (
    IN_PROCESS,
    checked_transport,
    chosen_transport,
    join_network,
)
from navette.runtime.overrides import ParameterOverrides
from navette.transports import InProcessTransport

if TYPE_CHECKING:
    from navette.runtime.node import Node


_LONGEST_CALLBACK_S = 2.0


class Context:
    """What nodes share. ``clock`` decides how time passes.

    By default it is the system's, or that of the simulator of a lock-step
    (``NAVETTE_LOCKSTEP=follow``).

    As in rclpy it becomes valid with :meth:`init`; a context that was made by hand
    initialises itself, without arguments, when its first node is made.

    Args:
        graph: one that several contexts share, each with a loop of its own, so that
            programs in one process meet; its maker closes its transports.
        transport: ``inprocess`` or ``zenoh`` (which is in process and the network);
            None: ``NAVETTE_TRANSPORT``, else the network, except in lock-step virtual
            time and under pytest.
    """

    def __init__(
        self,
        *,
        clock: ContextClock | None = None,
        graph: Graph | None = None,
        transport: str | None = None,
    ) -> None:
        if transport is not None:
            checked_transport(transport, "Context")
        self._transport = transport
        self.loop = EventLoop(clock or clock_of_environment())
        scope = current_scope.get()
        graph = graph or scope.graph
        self._owns_graph = graph is None
        self.graph = new_graph() if graph is None else graph
        self._leave_graph = self.graph.on_change(self._look_around)
        scope.contexts.add(self)
        self.overrides = ParameterOverrides()
        self.log = LogHub(lambda: self.loop.clock.now_ns)
        self.arguments = RosArguments()
        self.nodes: list[Node] = []
        #: The executor that module-level ``spin`` uses; made on demand.
        self.executor: Any = None
        self._initialized = False
        self._shut_down = False
        self._shut_down_by_program = False
        self._domain_id = 0
        self._on_shutdown: list[Callable[[], object]] = []
        self._lock = threading.RLock()
        self._file_sink: FileSink | None = None
        self._handler = StdlibHandler(self.log, lambda: self.loop.running_node)

    @property
    def clock(self) -> ContextClock:
        """How time passes here."""
        return self.loop.clock

    def use_clock(self, clock: ContextClock) -> None:
        """Let time pass as ``clock`` says; only while the context has no nodes."""
        if clock is self.loop.clock:
            return
        if self.loop.clock.is_shared and self._initialized:
            raise InvalidValueError("the context is in lock-step: its clock stays")
        if self.nodes:
            raise InvalidValueError(
                "the context's clock cannot change once it has nodes "
                f"({', '.join(n.get_fully_qualified_name() for n in self.nodes)})"
            )
        self.loop.clock = clock

    def init(
        self,
        args: Sequence[str] | None = None,
        *,
        initialize_logging: bool = True,
        domain_id: int | None = None,
        console_level: LoggingSeverity = LoggingSeverity.DEBUG,
    ) -> None:
        """Read the arguments (``sys.argv`` if None) and become valid.

        What is less severe than ``console_level`` goes to file and /rosout only.
        """
        with self._lock:
            if self._initialized:
                raise RuntimeError("Context.init() must only be called once")
            arguments = parse_ros_arguments(sys.argv if args is None else args)
            self._domain_id = _domain_id(domain_id)
            self._join_network()
            self.overrides.add_arguments(arguments.parameters, "command line")
            self.arguments = arguments
            if initialize_logging:
                self._start_logging(arguments, console_level)
            self._initialized = True

    def init_if_needed(self) -> None:
        """Become valid without arguments, if it was never initialised."""
        if not self._initialized:
            self.init(args=[])

    def ok(self) -> bool:
        """Whether it is initialised and not shut down."""
        return self._initialized and not self._shut_down

    @property
    def handle(self) -> Handle:
        """What rclpy's wait set takes."""
        return Handle(self)

    @property
    def was_shut_down(self) -> bool:
        """Whether it was valid once and is not any more."""
        return self._shut_down

    def shutdown(self) -> None:
        """End every spin and wait; after a signal has done so, nothing.

        Raises:
            RCLError: the program has done so already.
        """
        self._end(by_program=True)

    def _end(self, *, by_program: bool) -> None:
        with self._lock:
            if not self._initialized:
                raise RuntimeError(
                    "the context must be initialised before it can be shut down"
                )
            if self._shut_down:
                if by_program and self._shut_down_by_program:
                    raise RCLError(
                        "the context was shut down already; try_shutdown() is for "
                        "where it may have been"
                    )
                return
            self._shut_down = True
            self._shut_down_by_program = by_program
        self.loop.close()
        # The nodes must not be taken from under a callback of another thread; one
        # that blocks for longer (a sleep, a join of this thread) is not waited for.
        self.loop.wait_for_end(_LONGEST_CALLBACK_S)
        callbacks, self._on_shutdown = self._on_shutdown, []
        for callback in callbacks:
            callback()
        for node in tuple(self.nodes):
            node.destroy_node()
        self._leave_graph()
        if self._owns_graph:
            self.graph.close()
        self._stop_logging()

    def try_shutdown(self) -> None:
        """Shut down if it is valid."""
        if self.ok():
            self._end(by_program=False)

    def destroy(self) -> None:
        self.try_shutdown()

    def on_shutdown(self, callback: Callable[[], object]) -> None:
        """Call ``callback`` when the context is shut down."""
        self._on_shutdown.append(callback)

    def get_domain_id(self) -> int:
        return self._domain_id

    def check_overrides(self, nodes: "Sequence[Node] | None" = None) -> None:
        """Raise if a given parameter value reaches no node (see ParameterOverrides).

        Call it once all nodes exist.
        """
        self.overrides.check(self.nodes if nodes is None else nodes)

    def __enter__(self) -> "Context":
        self.init_if_needed()
        return self

    def __exit__(
        self,
        exc_type: type[BaseException] | None,
        exc_val: BaseException | None,
        exc_tb: TracebackType | None,
    ) -> None:
        self.try_shutdown()

    def _join_network(self) -> None:
        if chosen_transport(self._transport, self.clock) == IN_PROCESS:
            return
        # A graph that began without the network stays so, unless asked otherwise.
        if self._transport is None and self.graph.nodes():
            return
        lock_step = self.clock if isinstance(self.clock, LockStepClock) else None
        if lock_step is not None:
            lock_step.on_end = self.try_shutdown
        join_network(self.graph, self._domain_id, lambda: self.clock.now_ns, lock_step)

    def _look_around(self) -> None:
        """Something came or went by another thread: a wait may be for just that."""
        if not self.loop.in_driver_thread:
            self.loop.wake()

    def _start_logging(
        self, arguments: RosArguments, console_level: LoggingSeverity
    ) -> None:
        for name, level in arguments.log_levels:
            self.log.set_level(name or "", level)
        if arguments.enable_stdout:
            self.log.sinks.append(ConsoleSink(least=console_level))
        if arguments.log_file is not None:
            self._file_sink = FileSink(arguments.log_file)
            self.log.sinks.append(self._file_sink)
        package = logging.getLogger("navette")
        package.addHandler(self._handler)
        # The hub's levels decide; the standard library's must not come before.
        if package.level == logging.NOTSET:
            package.setLevel(logging.DEBUG)

    def _stop_logging(self) -> None:
        logging.getLogger("navette").removeHandler(self._handler)
        # The console stays: a program may still say goodbye.
        if self._file_sink is not None:
            self.log.sinks.remove(self._file_sink)
            self._file_sink.close()


def _domain_id(given: int | None) -> int:
    if given is not None:
        return given
    text = os.environ.get("ROS_DOMAIN_ID", "0") or "0"
    if not text.isdigit():
        raise InvalidValueError(f"ROS_DOMAIN_ID {text!r}: wanted a number >= 0")
    return int(text)


def new_graph() -> Graph:
    """A graph of this process alone."""
    graph = Graph()
    graph.add_transport(InProcessTransport())
    return graph


class Scope:
    """What one program's contexts have in common; by default all of the process.

    Args:
        graph: where the contexts meet those of other programs in the process; None:
            each has a graph of its own.
        default: the context used where none is given; None: one is made.
    """

    def __init__(
        self, graph: Graph | None = None, default: Context | None = None
    ) -> None:
        self.graph = graph
        #: Those still in use, in no particular order.
        self.contexts: WeakSet[Context] = WeakSet()
        self._default = default
        self._lock = threading.Lock()

    def default_context(self) -> Context:
        """The context used where none is given; made on first use."""
        with self._lock:
            if self._default is None:
                self._default = Context()
            return self._default

    def reset_default_context(self) -> None:
        with self._lock:
            self._default = None


#: The scope of the running thread or task.
current_scope: ContextVar[Scope] = ContextVar(
    "navette_scope",
    default=Scope(),  # noqa: B039 - one for the process is meant
)


def get_default_context(*, shutting_down: bool = False) -> Context:
    """The context used where none is given; a new one after a shutdown."""
    return current_scope.get().default_context()


def reset_default_context() -> None:
    """Forget the default context, so that the next use makes a fresh one."""
    current_scope.get().reset_default_context()
