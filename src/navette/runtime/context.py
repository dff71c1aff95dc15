"""Context: the graph, event loop, clock, arguments and log that nodes share."""

import gc
import logging
import sys
import threading
from collections.abc import Callable, Sequence
from contextvars import ContextVar
from typing import Any, ClassVar
from weakref import WeakSet

from navette.errors import FileFormatError, InvalidValueError
from navette.files.runs import PrivateRun, RunInfo
from navette.runtime.arguments import RosArguments, parse_ros_arguments
from navette.runtime.clock import ContextClock
from navette.runtime.exceptions import ParameterFileError, RCLError
from navette.runtime.graph import Graph
from navette.runtime.handles import HasHandle
from navette.runtime.input_check import SharedInputChecks
from navette.runtime.lockstep import LockStepClock, clock_of_environment
from navette.runtime.log import LogHub, StdlibHandler
from navette.runtime.log_levels import LoggingSeverity
from navette.runtime.log_sinks import ConsoleSink, FileSink, new_log_file
from navette.runtime.loop import EventLoop
from navette.runtime.network import (
    IN_PROCESS,
    checked_transport,
    chosen_transport,
    environment_domain,
    join_network,
)
from navette.runtime.overrides import ParameterOverrides, ParameterOwner
from navette.runtime.planar_odometry import SharedPlanarOdometry
from navette.transports import InProcessTransport

_log = logging.getLogger(__name__)

_LONGEST_CALLBACK_S = 2.0


class Context(HasHandle):
    """Everything that the nodes of one program share.

    As in rclpy, a context becomes valid with :meth:`init`. A context that a program
    creates itself is initialised, without arguments, when its first node is created.

    Args:
        clock: how time passes. Default: the system clock, or the simulator's clock in
            a lock-step run (``NAVETTE_LOCKSTEP=follow``).
        graph: a graph to share with other contexts of the process, each with its own
            loop. The caller closes the graph's transports.
        transport: ``inprocess``, or ``zenoh`` (in process and network). Default:
            ``NAVETTE_TRANSPORT`` if set; otherwise the network, except in lock-step
            virtual time and under pytest.
        run: the private run that this context is; it ends with the context. Default:
            the context joins the run that ``NAVETTE_RUN`` names; with the system clock
            also the only run of this user; else the shared network.
    """

    _has_exempted: ClassVar[bool] = False

    def __init__(
        self,
        *,
        clock: ContextClock | None = None,
        graph: Graph | None = None,
        transport: str | None = None,
        run: PrivateRun | None = None,
    ) -> None:
        if transport is not None:
            checked_transport(transport, "Context")
        self._transport = transport
        self.loop = EventLoop(clock or clock_of_environment())
        scope = current_scope.get()
        graph = graph or scope.graph
        self._owns_graph = graph is None
        self.graph = new_graph() if graph is None else graph
        self._leave_graph = self.graph.on_change(self._on_graph_change)
        scope.contexts.add(self)
        self.overrides = ParameterOverrides()
        self.log = LogHub(self.loop)
        self.arguments = RosArguments()
        self.input_checks = SharedInputChecks()
        self.planar_odometry = SharedPlanarOdometry()
        #: The nodes, oldest first (typed Any because Node imports this module).
        self.nodes: list[Any] = []
        #: The executor of module-level ``spin``; created on demand.
        self.executor: Any = None
        self._initialized = False
        self._exempts = False
        self._shut_down = False
        self._shut_down_by_program = False
        self._domain_id = 0
        self._own_run = run
        self._on_shutdown: list[Callable[[], object]] = []
        self._lock = threading.RLock()
        self._file_sink: FileSink | None = None
        self._handler = StdlibHandler(self.log)

    @property
    def clock(self) -> ContextClock:
        """The clock of the context's loop."""
        return self.loop.clock

    def use_clock(self, clock: ContextClock) -> None:
        """Replace the clock.

        Raises:
            InvalidValueError: the context has nodes, or is part of a lock-step run.
        """
        if clock is self.loop.clock:
            return
        if self.loop.clock.is_shared and self._initialized:
            raise InvalidValueError(
                "the clock of a context in a lock-step run cannot be replaced"
            )
        if self.nodes:
            raise InvalidValueError(
                "the clock of a context with nodes cannot be replaced "
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
        """Parse the arguments (``sys.argv`` if None) and make the context valid.

        Args:
            console_level: records below this level go to file and /rosout only.
        """
        with self._lock:
            if self._initialized:
                raise RuntimeError("Context.init() must only be called once")
            arguments = parse_ros_arguments(sys.argv if args is None else args)
            self._domain_id = environment_domain() if domain_id is None else domain_id
            joined = self._join_network(domain_id)
            try:
                self.overrides.add_arguments(arguments.parameters, "command line")
            except FileFormatError as error:
                raise ParameterFileError(error.path, error.reason, error.line) from None
            self.arguments = arguments
            if initialize_logging:
                self._start_logging(arguments, console_level)
            if joined is not None and self._own_run is None:
                _log.info("joined run %s (%s)", joined.name, joined.command)
            self._initialized = True

    def init_if_needed(self) -> None:
        """Initialise without arguments, unless the context was initialised before."""
        if not self._initialized:
            self.init(args=[])

    def ok(self) -> bool:
        """Return whether the context is initialised and not shut down."""
        return self._initialized and not self._shut_down

    @property
    def was_shut_down(self) -> bool:
        """Whether the context was valid and has been shut down."""
        return self._shut_down

    def shutdown(self) -> None:
        """End all spins and waits and destroy all nodes.

        Without effect after a shutdown by a signal.

        Raises:
            RCLError: the program has shut the context down before.
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
                        "the context is already shut down; call try_shutdown() where "
                        "this is possible"
                    )
                return
            self._shut_down = True
            self._shut_down_by_program = by_program
        self.loop.close()
        # Nodes must not be destroyed while another thread runs a callback. The wait
        # is limited: the callback may be sleeping, or joining this thread.
        self.loop.wait_for_end(_LONGEST_CALLBACK_S)
        callbacks, self._on_shutdown = self._on_shutdown, []
        for callback in callbacks:
            callback()
        for node in tuple(self.nodes):
            node.destroy_node()
        self._leave_graph()
        if self._owns_graph:
            self.graph.close()
        if self._own_run is not None:
            self._own_run.close()
        if self._exempts:
            gc.unfreeze()
        self._stop_logging()

    def try_shutdown(self) -> None:
        """Shut down if the context is valid."""
        if self.ok():
            self._end(by_program=False)

    def destroy(self) -> None:
        self.try_shutdown()

    def exempt_from_collection(self) -> None:
        """Exempt the objects that exist from garbage collection until the shutdown.

        Called before the first event. Modules and nodes are needed as long as the
        context. Traversing them would take the collector 10 to 20 ms each time, in the
        middle of a callback. Only the first context of a process does so: for a later
        one, what earlier ones left would be kept, too.
        """
        if not Context._has_exempted:
            Context._has_exempted = self._exempts = True
            gc.freeze()

    def on_shutdown(self, callback: Callable[[], object]) -> None:
        """Call ``callback`` when the context is shut down."""
        self._on_shutdown.append(callback)

    def get_domain_id(self) -> int:
        return self._domain_id

    def check_overrides(self, nodes: Sequence[ParameterOwner] | None = None) -> None:
        """Raise if a parameter override matches no node; call when all nodes exist."""
        self.overrides.check(self.nodes if nodes is None else nodes)

    def __enter__(self) -> "Context":
        self.init_if_needed()
        return self

    def __exit__(self, *exc_info: object) -> None:
        self.try_shutdown()

    def _join_network(self, domain_id: int | None) -> RunInfo | None:
        """Join the network if the program uses it; return the private run, if any."""
        if chosen_transport(self._transport, self.clock) == IN_PROCESS:
            return None
        # A graph with nodes stays without the network, unless the caller requests it.
        if self._transport is None and self.graph.nodes():
            return None
        lock_step = self.clock if isinstance(self.clock, LockStepClock) else None
        if lock_step is not None:
            lock_step.on_end = self.try_shutdown
        membership = join_network(
            self.graph,
            self.loop,
            domain_id=domain_id,
            own_run=None if self._own_run is None else self._own_run.info,
            # Time of its own means a system of its own.
            named_only=self.clock.is_virtual,
            lock_step=lock_step,
        )
        self._domain_id = membership.domain_id
        return membership.run

    def _on_graph_change(self) -> None:
        """Wake the loop: a callback may be waiting for this change."""
        if not self.loop.in_driver_thread:
            self.loop.wake()

    def _start_logging(
        self, arguments: RosArguments, console_level: LoggingSeverity
    ) -> None:
        for name, level in arguments.log_levels:
            self.log.set_level(name or "", level)
        if arguments.enable_stdout:
            self.log.sinks.append(ConsoleSink(least=console_level))
        log_file = arguments.log_file
        if arguments.log_file_name is not None:
            log_file = new_log_file(arguments.log_file_name)
        if log_file is not None:
            self._file_sink = FileSink(log_file)
            self.log.sinks.append(self._file_sink)
        package = logging.getLogger("navette")
        package.addHandler(self._handler)
        # The hub's levels apply; the standard library must not filter before.
        if package.level == logging.NOTSET:
            package.setLevel(logging.DEBUG)

    def _stop_logging(self) -> None:
        logging.getLogger("navette").removeHandler(self._handler)
        # The console sink stays: a program may still log after the shutdown.
        if self._file_sink is not None:
            self.log.sinks.remove(self._file_sink)
            self._file_sink.close()


def new_graph() -> Graph:
    """Return a graph of this process without a network transport."""
    graph = Graph()
    graph.add_transport(InProcessTransport())
    return graph


class Scope:
    """Contexts of one program; by default those of the process.

    Args:
        graph: graph shared with other programs of the process. Default: each context
            has its own graph.
        default: the default context. Default: created on first use.
    """

    def __init__(
        self, graph: Graph | None = None, default: Context | None = None
    ) -> None:
        self.graph = graph
        #: The contexts still in use, in no particular order.
        self.contexts: WeakSet[Context] = WeakSet()
        self._default = default
        self._lock = threading.Lock()

    def default_context(self) -> Context:
        """Return the default context, created on first use."""
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
    """Return the default context."""
    return current_scope.get().default_context()


def reset_default_context() -> None:
    """Remove the default context; the next use creates a new one."""
    current_scope.get().reset_default_context()
