"""Nodes, with rclpy's API."""

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

from navette.errors import InvalidValueError, NavetteError
from navette.msgs.rcl_interfaces.msg import (
    Log,
    ParameterEvent,
)
from navette.runtime.arguments import RosArguments, parse_ros_arguments
from navette.runtime.callback_groups import CallbackGroup
from navette.runtime.client import Client
from navette.runtime.context import Context, get_default_context
from navette.runtime.exceptions import NotInitializedException
from navette.runtime.graph_queries import GraphQueries
from navette.runtime.guard_condition import GuardCondition
from navette.runtime.handles import HasHandle
from navette.runtime.log import Logger
from navette.runtime.logging_service import LoggingService
from navette.runtime.names import (
    NodeRemapper,
    RemapRule,
    validate_namespace,
    validate_node_name,
)
from navette.runtime.node_entities import NodeEntities
from navette.runtime.node_parameters import NodeParameters
from navette.runtime.node_services import NodeServices
from navette.runtime.node_topics import NodeTopics
from navette.runtime.overrides import Override, ParameterOverrides
from navette.runtime.parameter import Parameter
from navette.runtime.parameter_service import ParameterService
from navette.runtime.parameter_store import (
    REL_TOL,
    Changes,
)
from navette.runtime.publisher import Publisher
from navette.runtime.qos import (
    QoSProfile,
    qos_profile_parameter_events,
    qos_profile_rosout_default,
    qos_profile_services_default,
)
from navette.runtime.qos_events import (
    PublisherEventCallbacks,
    SubscriptionEventCallbacks,
)
from navette.runtime.qos_overriding_options import QoSOverridingOptions
from navette.runtime.rate import Rate
from navette.runtime.ros_clock import Clock, ROSClock
from navette.runtime.rosout import RosoutSink
from navette.runtime.service import Service
from navette.runtime.subscription import ContentFilterOptions, Subscription
from navette.runtime.time import ns_to_stamp, seconds_to_ns
from navette.runtime.time_source import TimeSource
from navette.runtime.timer import Timer
from navette.runtime.type_description_service import TypeDescriptionService
from navette.runtime.type_support import interface_name
from navette.runtime.waitable import Waitable, WaitableEvents
from navette.transports import NodeInfo

HIDDEN_NODE_PREFIX = "_"

MsgT = TypeVar("MsgT")


#: rclpy's private tables by name, and what they are here. They are not attributes, so
#: that a node class may have its own of that name.
_PRIVATE_TABLES = {"_parameters": "values", "_descriptors": "descriptors"}


class Node(HasHandle, GraphQueries, NodeParameters):
    """Owns publishers, subscriptions, services, timers and parameters under one name.

    Arguments as in rclpy; ``parameter_overrides`` take precedence over values from
    files and the command line. Two base classes, which work without each other, provide
    the graph queries and the parameters; :class:`NodeTopics` and :class:`NodeServices`
    create the endpoints, and :class:`NodeEntities` registers what the node owns.
    """

    PARAM_REL_TOL = REL_TOL

    if not TYPE_CHECKING:  # type checkers would accept any attribute name

        def __getattr__(self, name: str) -> Any:
            """Return a table that programs read although it is private in rclpy.

            Raises:
                AttributeError: mentions a missing ``super().__init__`` call.
            """
            if name in _PRIVATE_TABLES and "_node_store" in vars(self):
                return dict(getattr(self._node_store, _PRIVATE_TABLES[name]))
            text = f"{type(self).__name__!r} object has no attribute {name!r}"
            if "_node_entities" not in vars(self):
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
        remaps = self._context.arguments.remaps if use_global_arguments else []
        remapper = _node_remapper(node_name, namespace or "", [*local.remaps, *remaps])
        GraphQueries.__init__(self, self._context.graph, self._context.loop, remapper)
        self._node_entities = entities = NodeEntities(self._context, remapper)
        self._node_executor: Any = None
        self._clock = ROSClock(context=self._context)
        logger_name = entities.full_name.strip("/").replace("/", ".")
        self._logger = Logger(logger_name, self._context.log)
        NodeParameters.__init__(
            self,
            entities.full_name,
            _collected_overrides(
                entities.full_name,
                self._context.overrides if use_global_arguments else None,
                local,
                parameter_overrides or (),
            ),
            on_change=self._node_publish_changes,
            allow_undeclared=allow_undeclared_parameters,
        )
        self._node_topics = NodeTopics(entities, self, self._logger)
        self._node_services = NodeServices(entities, self._node_topics)
        self._node_rosout_sink: RosoutSink | None = None
        self._node_info = NodeInfo(
            remapper.node_name, remapper.namespace, self._context.arguments.enclave
        )
        self._node_join_graph()
        try:
            if enable_rosout and self._context.arguments.enable_rosout:
                self._node_open_rosout()
            self._node_parameter_events = self._node_topics.create_publisher(
                ParameterEvent, "/parameter_events", qos_profile_parameter_events
            )
            if automatically_declare_parameters_from_overrides:
                for name, override in self._node_overrides.items():
                    self.declare_parameter(name, override.value)
            self._node_start_services(start_parameter_services, enable_logger_service)
        except NavetteError:
            Node.destroy_node(self)  # leave no half-made node in the graph
            raise

    def _node_join_graph(self) -> None:
        full_name = self._node_entities.full_name
        if full_name in self.get_fully_qualified_node_names():
            self._logger.warning(
                f"another node is named {full_name}: node names should be unique"
            )
        self._context.graph.add_node(self._node_info)
        self._context.nodes.append(self)

    def _node_open_rosout(self) -> None:
        publisher = self._node_topics.create_publisher(
            Log, "/rosout", qos_profile_rosout_default
        )
        self._node_rosout_sink = RosoutSink(publisher, self._logger.name)
        self._context.log.sinks.append(self._node_rosout_sink)

    def _node_start_services(
        self, parameter_services: bool, logger_service: bool
    ) -> None:
        services = self._node_services
        self._time_source = TimeSource(
            self._context, self._clock, self, self._node_topics
        )
        if parameter_services:
            self._parameter_service = ParameterService(self, services)
        self._type_description_service = TypeDescriptionService(self, services)
        if logger_service:
            self._logging_service = LoggingService(self._context.log, services)

    def _node_publish_changes(self, changes: Changes) -> None:
        new, changed, deleted = changes
        if not self._node_parameter_events.get_subscription_count():
            return
        self._node_parameter_events.publish(
            ParameterEvent(
                stamp=ns_to_stamp(self._clock.now_ns),
                node=self._node_entities.full_name,
                new_parameters=[p.to_parameter_msg() for p in new],
                changed_parameters=[p.to_parameter_msg() for p in changed],
                deleted_parameters=[p.to_parameter_msg() for p in deleted],
            )
        )

    def destroy_node(self) -> None:
        """Destroy all entities and leave the graph; a second call has no effect."""
        if self._node_entities.is_destroyed:
            return
        sinks = self._context.log.sinks
        if self._node_rosout_sink is not None and self._node_rosout_sink in sinks:
            sinks.remove(self._node_rosout_sink)
        self._node_entities.destroy_all()
        if self._node_executor is not None:
            self._node_executor.remove_node(self)
        self._context.nodes.remove(self)
        self._context.graph.remove_node(self._node_info)

    def __enter__(self) -> "Node":
        return self

    def __exit__(self, *exc_info: object) -> None:
        self.destroy_node()

    # Identity, context and executor.

    def get_name(self) -> str:
        return self._node_remapper.node_name

    def get_namespace(self) -> str:
        return self._node_remapper.namespace

    def get_fully_qualified_name(self) -> str:
        return self._node_entities.full_name

    def get_clock(self) -> Clock:
        return self._clock

    def get_logger(self) -> Logger:
        return self._logger

    @property
    def context(self) -> Context:
        return self._context

    @property
    def executor(self) -> Any:
        """The executor that runs the node's callbacks, or None."""
        return self._node_executor

    @executor.setter
    def executor(self, executor: Any) -> None:
        if self._node_executor is not None and executor is not self._node_executor:
            self._node_executor.remove_node(self)
        if executor is not None:
            executor.add_node(self)

    def _node_attach(self, executor: Any) -> None:
        """Let callbacks run; called by the executor that the node is added to."""
        self._node_executor = executor
        self._node_entities.release(executor.threads)

    def _node_detach(self) -> None:
        """Hold callbacks; called by the executor that the node is removed from."""
        self._node_executor = None
        self._node_entities.hold()

    @property
    def default_callback_group(self) -> CallbackGroup:
        return self._node_entities.default_group

    # Topics.

    @property
    def publishers(self) -> Iterator[Publisher[Any]]:
        return self._node_entities.of_type(Publisher)

    @property
    def subscriptions(self) -> Iterator[Subscription[Any]]:
        return self._node_entities.of_type(Subscription)

    def create_publisher(
        self,
        msg_type: type[MsgT],
        topic: str,
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: PublisherEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        publisher_class: type[Publisher[Any]] = Publisher,
        other_types: Sequence[type | str] = (),
    ) -> Publisher[MsgT]:
        """Create a publisher on ``topic`` (relative, private or global; remapped).

        Args:
            other_types: further types that the topic may have, or their names.
        """
        return self._node_topics.create_publisher(
            msg_type,
            topic,
            qos_profile,
            event_callbacks=event_callbacks,
            qos_overriding_options=qos_overriding_options,
            publisher_class=publisher_class,
            other_types=other_types,
        )

    def create_subscription(
        self,
        msg_type: type[MsgT],
        topic: str,
        callback: Callable[..., Any],
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: SubscriptionEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        raw: bool = False,
        content_filter_options: ContentFilterOptions | None = None,
        shared: bool = False,
        other_types: Sequence[type | str] = (),
        ignore_local_publications: bool = False,
    ) -> Subscription[MsgT]:
        """Call ``callback(msg)`` or ``callback(msg, info)`` for every sample.

        Args:
            raw: pass the serialised bytes.
            content_filter_options: queue only samples that pass the filter.
            shared: pass the same, uncopied object to all shared subscriptions, which
                must not modify it.
            other_types: further types that the topic may have, each of which the node
                handles in another subscription.
            ignore_local_publications: receive nothing from publishers of this node.
        """
        return self._node_topics.create_subscription(
            msg_type,
            topic,
            callback,
            qos_profile,
            callback_group=callback_group,
            event_callbacks=event_callbacks,
            qos_overriding_options=qos_overriding_options,
            raw=raw,
            content_filter_options=content_filter_options,
            shared=shared,
            other_types=other_types,
            ignore_local_publications=ignore_local_publications,
        )

    def destroy_publisher(self, publisher: Publisher[Any]) -> bool:
        return self._node_entities.destroy(publisher)

    def destroy_subscription(self, subscription: Subscription[Any]) -> bool:
        return self._node_entities.destroy(subscription)

    # Services.

    @property
    def services(self) -> Iterator[Service]:
        return self._node_entities.of_type(Service)

    @property
    def clients(self) -> Iterator[Client]:
        return self._node_entities.of_type(Client)

    def create_service(
        self,
        srv_type: Any,
        srv_name: str,
        callback: Callable[[Any, Any], Any],
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> Service:
        """Respond to requests with ``callback(request, response) -> response``.

        The callback may be a coroutine function.
        """
        return self._node_serve(
            interface_name(srv_type, "srv"),
            srv_name,
            callback,
            qos_profile=qos_profile,
            callback_group=callback_group,
        )

    def _node_serve(
        self,
        type_name: str,
        srv_name: str,
        callback: Callable[[Any, Any], Any],
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
        deferred: bool = False,
    ) -> Service:
        """Create a service by type name; its classes are created on first use.

        Args:
            deferred: call ``callback(request, request_id)``, which responds at any time
                with :meth:`Service.send_response`.
        """
        return self._node_services.serve(
            type_name,
            srv_name,
            callback,
            qos_profile=qos_profile,
            callback_group=callback_group,
            deferred=deferred,
        )

    def create_client(
        self,
        srv_type: Any,
        srv_name: str,
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> Client:
        """Create a client of the service ``srv_name``."""
        return self._node_services.create_client(
            interface_name(srv_type, "srv"),
            srv_name,
            qos_profile=qos_profile,
            callback_group=callback_group,
        )

    def destroy_service(self, service: Service) -> bool:
        return self._node_entities.destroy(service)

    def destroy_client(self, client: Client) -> bool:
        return self._node_entities.destroy(client)

    # Timers, rates, guard conditions and waitables.

    @property
    def timers(self) -> Iterator[Timer]:
        return self._node_entities.of_type(Timer)

    @property
    def guards(self) -> Iterator[GuardCondition]:
        return self._node_entities.of_type(GuardCondition)

    @property
    def waitables(self) -> Iterator[Waitable[Any]]:
        return self._node_entities.of_type(Waitable)

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
            self._node_entities.adopt(callback_group),
            seconds_to_ns(float(timer_period_sec)),
            clock or self._clock,
            self._node_entities,
            autostart=autostart,
        )
        self._node_entities.add(timer)
        return timer

    def create_rate(self, frequency: float, clock: Clock | None = None) -> Rate:
        """Create a rate whose ``sleep()`` ends each period of ``frequency`` Hz."""
        if frequency <= 0:
            raise InvalidValueError(f"rate must be > 0 Hz, got {frequency!r}")
        rate = Rate(
            round(1e9 / frequency),
            clock or self._clock,
            self._node_entities,
        )
        self._node_entities.add(rate)
        return rate

    def create_guard_condition(
        self,
        callback: Callable[[], Any] | None,
        callback_group: CallbackGroup | None = None,
    ) -> GuardCondition:
        """Call ``callback`` after each ``trigger()`` of the guard condition."""
        guard = GuardCondition(
            callback,
            self._node_entities.adopt(callback_group),
            self._context,
            entities=self._node_entities,
        )
        self._node_entities.add(guard)
        return guard

    def add_waitable(self, waitable: Waitable[Any]) -> None:
        """Run a waitable when it is ready; the node destroys it at the end."""
        self._node_entities.add(waitable)
        if type(waitable).add_to_wait_set is Waitable.add_to_wait_set:
            return  # an action, whose services and topics the loop runs
        events = WaitableEvents(
            waitable,
            self._node_entities.adopt(waitable.callback_group),
            self._context.loop,
            self._node_entities.full_name,
        )
        waitable.add_to_wait_set(events.wait_set)

    def remove_waitable(self, waitable: Waitable[Any]) -> None:
        self._node_entities.forget(waitable)

    def destroy_timer(self, timer: Timer) -> bool:
        return self._node_entities.destroy(timer)

    def destroy_rate(self, rate: Rate) -> bool:
        return self._node_entities.destroy(rate)

    def destroy_guard_condition(self, guard: GuardCondition) -> bool:
        return self._node_entities.destroy(guard)


def _valid_context(context: Context | None) -> Context:
    if context is None:
        context = get_default_context()
    else:
        context.init_if_needed()
    if not context.ok():
        raise NotInitializedException("cannot create a node")
    return context


def _local_arguments(cli_args: Sequence[str] | None) -> RosArguments:
    """Parse a node's own arguments; the leading ``--ros-args`` is optional."""
    if not cli_args:
        return RosArguments()
    args = list(cli_args)
    if "--ros-args" not in args:
        args.insert(0, "--ros-args")
    return parse_ros_arguments(args)


def _node_remapper(name: str, namespace: str, rules: list[RemapRule]) -> NodeRemapper:
    validate_node_name(name)
    remapper = NodeRemapper(rules, name, namespace)
    validate_node_name(remapper.node_name)
    validate_namespace(remapper.namespace)
    return remapper


def _collected_overrides(
    node_name: str,
    shared: ParameterOverrides | None,
    local: RosArguments,
    given: Sequence[Parameter[Any]],
) -> dict[str, Override]:
    """Merge overrides of context, node arguments and code, in rising precedence."""
    own = ParameterOverrides()
    own.add_arguments(local.parameters, "node arguments")
    return {
        **(shared.for_node(node_name) if shared is not None else {}),
        **own.for_node(node_name),
        **{p.name: Override(p.value, "parameter_overrides") for p in given},
    }
