"""Nodes, with rclpy's API."""

from collections.abc import Callable, Iterator, Sequence
from types import TracebackType
from typing import TYPE_CHECKING, Any, NoReturn

from navette.errors import InvalidValueError, NavetteError
from navette.msgs.rcl_interfaces.msg import Log, ParameterEvent
from navette.runtime.arguments import RosArguments, parse_ros_arguments
from navette.runtime.callback_groups import (
    CallbackGroup,
    MutuallyExclusiveCallbackGroup,
)
from navette.runtime.context import Context, get_default_context
from navette.runtime.exceptions import NotInitializedException
from navette.runtime.log import Logger, LogRecord
from navette.runtime.logging_service import LoggingService
from navette.runtime.names import (
    NodeRemapper,
    full_node_name,
    validate_namespace,
    validate_node_name,
)
from navette.runtime.node_graph import NodeGraph
from navette.runtime.node_parameters import NodeParameters
from navette.runtime.node_services import NodeServices
from navette.runtime.node_topics import NodeTopics
from navette.runtime.node_waitables import NodeWaitables
from navette.runtime.overrides import Override, ParameterOverrides
from navette.runtime.parameter import Parameter
from navette.runtime.parameter_service import ParameterService
from navette.runtime.parameter_store import Changes, ParameterStore
from navette.runtime.publisher import Publisher
from navette.runtime.qos import (
    qos_profile_parameter_events,
    qos_profile_rosout_default,
)
from navette.runtime.rate import Rate
from navette.runtime.ros_clock import Clock, ROSClock
from navette.runtime.time import ns_to_stamp, seconds_to_ns
from navette.runtime.time_source import TimeSource
from navette.runtime.timer import Timer
from navette.runtime.type_description_service import TypeDescriptionService
from navette.transports import NodeInfo

HIDDEN_NODE_PREFIX = "_"


class Node(NodeParameters, NodeTopics, NodeServices, NodeWaitables, NodeGraph):
    """Owns publishers, subscriptions, timers and parameters under one name.

    Args as in rclpy; ``parameter_overrides`` win over everything else.
    """

    if not TYPE_CHECKING:  # else every name would be an attribute to type checkers

        def __getattr__(self, name: str) -> NoReturn:
            """Of what is not there: tell those who forgot ``super().__init__``."""
            text = f"{type(self).__name__!r} object has no attribute {name!r}"
            if "_destroyed" not in vars(self):
                text += (
                    ": the node is not initialised yet; call super().__init__('name') "
                    "first in its __init__"
                )
            raise AttributeError(text, name=name, obj=self)

    def __init__(
        self,
        node_name: str,
        *,
        context: Context | None = None,
        cli_args: Sequence[str] | None = None,
        namespace: str | None = None,
        use_global_arguments: bool = True,
        enable_rosout: bool = True,
        start_parameter_services: bool = True,
        parameter_overrides: Sequence[Parameter[Any]] | None = None,
        allow_undeclared_parameters: bool = False,
        automatically_declare_parameters_from_overrides: bool = False,
        enable_logger_service: bool = False,
    ) -> None:
        self._context = _valid_context(context)
        local = _local_arguments(cli_args)
        self._name_node(node_name, namespace or "", local, use_global_arguments)
        full_name = self.get_fully_qualified_name()
        self._overrides = self._collect_overrides(
            local, parameter_overrides or (), use_global_arguments
        )
        self._executor: Any = None
        self._destroyed = False
        self._entities: list[Any] = []
        self._groups: list[CallbackGroup] = []
        self._default_group = self._own_group(MutuallyExclusiveCallbackGroup())
        self._clock = ROSClock(context=self._context)
        self._logger = Logger(full_name.strip("/").replace("/", "."), self._context.log)
        self._store = ParameterStore(
            self._report_changes, allow_undeclared=allow_undeclared_parameters
        )
        self._info = NodeInfo(
            self.get_name(), self.get_namespace(), self._context.arguments.enclave
        )
        self._rosout: Publisher[Any] | None = None
        self._join_graph()
        try:
            self._open(enable_rosout and self._context.arguments.enable_rosout)
            if automatically_declare_parameters_from_overrides:
                for name, override in self._overrides.items():
                    self.declare_parameter(name, override.value)
            self._time_source = TimeSource(self)
            if start_parameter_services:
                self._parameter_service = ParameterService(self)
            self._type_description_service = TypeDescriptionService(self)
            if enable_logger_service:
                self._logging_service = LoggingService(self)
        except NavetteError:
            Node.destroy_node(self)  # leave no half-made node in the graph
            raise

    # -- who it is -------------------------------------------------------------

    def get_name(self) -> str:
        return self._remapper.node_name

    def get_namespace(self) -> str:
        return self._remapper.namespace

    def get_fully_qualified_name(self) -> str:
        return full_node_name(self.get_name(), self.get_namespace())

    def get_clock(self) -> Clock:
        return self._clock

    def get_logger(self) -> Logger:
        return self._logger

    @property
    def context(self) -> Context:
        return self._context

    @property
    def executor(self) -> Any:
        """The executor that runs its callbacks, if it was added to one."""
        return self._executor

    @executor.setter
    def executor(self, executor: Any) -> None:
        if self._executor is not None and executor is not self._executor:
            self._executor.remove_node(self)
        if executor is not None:
            executor.add_node(self)

    @property
    def default_callback_group(self) -> CallbackGroup:
        return self._default_group

    @property
    def timers(self) -> Iterator[Timer]:
        return (e for e in self._entities if isinstance(e, Timer))

    # -- time ------------------------------------------------------------------

    def create_timer(
        self,
        timer_period_sec: float,
        callback: Callable[..., Any] | None,
        callback_group: CallbackGroup | None = None,
        clock: Clock | None = None,
        autostart: bool = True,
    ) -> Timer:
        """Call ``callback`` every ``timer_period_sec`` seconds of the clock."""
        timer = Timer(
            callback,
            self._own_group(callback_group),
            seconds_to_ns(float(timer_period_sec)),
            clock or self._clock,
            node_name=self.get_fully_qualified_name(),
            on_destroy=self._forget,
            autostart=autostart,
        )
        timer.group.add_entity(timer)
        self._entities.append(timer)
        return timer

    def create_rate(self, frequency: float, clock: Clock | None = None) -> Rate:
        """``rate.sleep()`` lets the rest of a period of ``frequency`` Hz pass."""
        if frequency <= 0:
            raise InvalidValueError(f"rate {frequency!r} Hz: wanted > 0")
        rate = Rate(
            round(1e9 / frequency), clock or self._clock, self._context, self._forget
        )
        self._entities.append(rate)
        return rate

    def call_soon(self, function: Callable[[], Any], source: str) -> None:
        """Run ``function`` as an event of this node."""
        self._context.loop.call_soon(function, source, self.get_fully_qualified_name())

    # -- taking down -----------------------------------------------------------

    def destroy_timer(self, timer: Timer) -> bool:
        return self._destroy(timer)

    def destroy_rate(self, rate: Rate) -> bool:
        return self._destroy(rate)

    def destroy_node(self) -> None:
        """Take everything down; a second call does nothing."""
        if self._destroyed:
            return
        self._destroyed = True
        if self._rosout is not None and self._to_rosout in self._context.log.sinks:
            self._context.log.sinks.remove(self._to_rosout)
        for entity in tuple(self._entities):
            entity.destroy()
        if self._executor is not None:
            self._executor.remove_node(self)
        self._context.nodes.remove(self)
        self._context.graph.remove_node(self._info)

    def __enter__(self) -> "Node":
        return self

    def __exit__(
        self,
        exc_type: type[BaseException] | None,
        exc_val: BaseException | None,
        exc_tb: TracebackType | None,
    ) -> None:
        self.destroy_node()

    # -- inside ----------------------------------------------------------------

    def attach(self, executor: Any) -> None:
        """Let callbacks run; called by the executor that the node was added to."""
        self._executor = executor
        for group in self._groups:
            group.release()

    def detach(self) -> None:
        """Keep callbacks back; called by the executor that let go of the node."""
        self._executor = None
        for group in self._groups:
            group.hold()

    def _join_graph(self) -> None:
        full_name = self.get_fully_qualified_name()
        if full_name in self.get_fully_qualified_node_names():
            self._logger.warning(
                f"there is a node {full_name} already: names should be unique"
            )
        self._context.graph.add_node(self._info)
        self._context.nodes.append(self)

    def _open(self, rosout: bool) -> None:
        """The topics that every node has."""
        if rosout:
            self._rosout = self.create_publisher(
                Log, "/rosout", qos_profile_rosout_default
            )
            self._context.log.sinks.append(self._to_rosout)
        self._parameter_events = self.create_publisher(
            ParameterEvent, "/parameter_events", qos_profile_parameter_events
        )

    def _check_alive(self) -> None:
        if self._destroyed:
            raise InvalidValueError(
                f"node {self.get_fully_qualified_name()} was destroyed"
            )

    def _own_group(self, group: CallbackGroup | None) -> CallbackGroup:
        if group is None:
            return self._default_group
        if group not in self._groups:
            self._groups.append(group)
            group.ready = self._context.loop.ready
            if self._executor is None:
                group.hold()
        return group

    def _forget(self, entity: Any) -> None:
        if entity in self._entities:
            self._entities.remove(entity)
        group = getattr(entity, "group", None) or getattr(
            entity, "callback_group", None
        )
        if group is not None:
            group.remove_entity(entity)

    def _destroy(self, entity: Any) -> bool:
        if entity not in self._entities:
            return False
        entity.destroy()
        return True

    def _name_node(
        self, name: str, namespace: str, local: RosArguments, use_global: bool
    ) -> None:
        validate_node_name(name)
        rules = list(local.remaps)
        if use_global:
            rules += self._context.arguments.remaps
        self._remapper = NodeRemapper(rules, name, namespace)
        validate_node_name(self._remapper.node_name)
        validate_namespace(self._remapper.namespace)

    def _collect_overrides(
        self,
        local: RosArguments,
        given: Sequence[Parameter[Any]],
        use_global: bool,
    ) -> dict[str, Override]:
        """Weakest to strongest: the context's, the node's arguments, the code's."""
        full_name = self.get_fully_qualified_name()
        chosen: dict[str, Override] = {}
        if use_global:
            chosen.update(self._context.overrides.for_node(full_name))
        own = ParameterOverrides()
        own.add_arguments(local.parameters, "node arguments")
        chosen.update(own.for_node(full_name))
        chosen.update({p.name: Override(p.value, "parameter_overrides") for p in given})
        return chosen

    def _report_changes(self, changes: Changes) -> None:
        new, changed, deleted = changes
        if not self._parameter_events.get_subscription_count():
            return
        self._parameter_events.publish(
            ParameterEvent(
                stamp=ns_to_stamp(self._clock.now_ns),
                node=self.get_fully_qualified_name(),
                new_parameters=[p.to_parameter_msg() for p in new],
                changed_parameters=[p.to_parameter_msg() for p in changed],
                deleted_parameters=[p.to_parameter_msg() for p in deleted],
            )
        )

    def _to_rosout(self, record: LogRecord) -> None:
        name = self._logger.name
        if record.name != name and not record.name.startswith(f"{name}."):
            return
        assert self._rosout is not None, "the sink is added with the publisher"
        self._rosout.publish(
            Log(
                stamp=ns_to_stamp(record.stamp_ns),
                level=int(record.severity),
                name=record.name,
                msg=record.message,
                file=record.file,
                function=record.function,
                line=record.line,
            )
        )


def _valid_context(context: Context | None) -> Context:
    if context is None:
        context = get_default_context()
    else:
        context.init_if_needed()
    if not context.ok():
        raise NotInitializedException("cannot create a node")
    return context


def _local_arguments(cli_args: Sequence[str] | None) -> RosArguments:
    """A node's own arguments; the leading ``--ros-args`` may be left out."""
    if not cli_args:
        return RosArguments()
    args = list(cli_args)
    if "--ros-args" not in args:
        args.insert(0, "--ros-args")
    return parse_ros_arguments(args)
