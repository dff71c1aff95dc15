"""Base class of Navette's nodes: topics and parameters are declared as data."""

import dataclasses
import math
from collections import defaultdict
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, fields
from functools import cached_property, partial
from typing import Any, ClassVar, Self

from navette.errors import (
    InvalidInputError,
    NavetteError,
    ParameterError,
    UnknownNameError,
    instead_of,
)
from navette.msgs import get_interface, type_name
from navette.msgs.rcl_interfaces.msg import SetParametersResult
from navette.msgs.topics import StackTopic
from navette.params import Params
from navette.params.plugins import method_fields, own_fields, with_methods
from navette.runtime.node import Node
from navette.runtime.parameter import Parameter
from navette.runtime.publisher import Publisher
from navette.runtime.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from navette.runtime.ros_clock import JumpThreshold, TimeJump
from navette.runtime.signatures import takes_arguments
from navette.runtime.stage.dropped_inputs import DroppedInputs
from navette.runtime.stage.params import declare_params
from navette.runtime.stamp_selection import StampSelection
from navette.runtime.subscription import MessageInfo, Subscription
from navette.runtime.time import Duration, stamp_to_ns
from navette.runtime.worker import Worker


@dataclass(frozen=True, kw_only=True)
class _Topic:
    """A topic that a stage subscribes to or publishes."""

    topic: str
    type: str
    role: str
    #: Expected rate, for documentation and viewers; None = published on events.
    rate_hz: float | None = None
    depth: int = 10
    #: Whether late subscribers receive the last samples (transient local).
    latched: bool = False
    best_effort: bool = False
    #: Further types that the topic may have; an input receives messages of each.
    other_types: tuple[str, ...] = ()

    @classmethod
    def of(cls, topic: StackTopic, role: str, **options: Any) -> Self:
        """Take name, type, depth and durability from the table of topics."""
        return cls(
            topic=topic.name,
            type=topic.type,
            role=role,
            depth=topic.depth,
            latched=topic.latched,
            **options,
        )

    @property
    def qos(self) -> QoSProfile:
        return QoSProfile(
            depth=self.depth,
            durability=(
                DurabilityPolicy.TRANSIENT_LOCAL
                if self.latched
                else DurabilityPolicy.VOLATILE
            ),
            reliability=(
                ReliabilityPolicy.BEST_EFFORT
                if self.best_effort
                else ReliabilityPolicy.RELIABLE
            ),
        )


OnMessage = Callable[..., Any]
"""Receives the messages of an input."""


@dataclass(frozen=True, kw_only=True)
class Input(_Topic):
    """A subscription; ``callback`` is the method that gets the message, or its name."""

    #: May take the message's MessageInfo as well.
    callback: str | OnMessage
    #: Time since the last arrival after which the input is stale; None = no limit.
    timeout_s: float | None = None
    #: Whether publications of this node are not received.
    ignores_own: bool = False
    #: Whether the contents must be valid, not only the stamp; False if the callback
    #: uses a part of them and checks that itself.
    checks_contents: bool = True
    #: The callback gets the last message of each period, by the stamps of the headers;
    #: infinite = every message. All count as arrivals.
    most_hz: float = math.inf


@dataclass(frozen=True, kw_only=True)
class Output(_Topic):
    """A publisher."""


class StageNode(Node):
    """Node that declares PARAMS, subscribes to INPUTS and publishes OUTPUTS.

    Input messages are shared with other subscribers: callbacks must not change them.
    Messages that cannot be used (NaN, a stamp before 1970, a grid of the wrong length)
    are dropped before the callback, and those for which the callback raises
    InvalidInputError: logged once per topic and reason, counted in
    :attr:`dropped_inputs` and on ``/diagnostics``, and not an arrival for
    :meth:`is_stale`.

    Raises:
        ParameterError: a parameter value given for this node is not allowed, or the
            node has no such parameter; lists the existing ones.
    """

    PARAMS: ClassVar[type[Params]] = Params
    INPUTS: ClassVar[tuple[Input, ...]] = ()
    OUTPUTS: ClassVar[tuple[Output, ...]] = ()
    #: Prefix, such as ``topics.NAME.``, of parameters beside PARAMS → their record.
    PARAM_GROUPS: ClassVar[Mapping[str, type[Params]]] = {}
    #: Parameters that cannot be set after the start.
    FIXED_AT_START: ClassVar[Collection[str]] = ()

    params: Any

    def __init__(self, node_name: str, **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        try:
            self._set_up()
        except NavetteError:
            # Remove the incomplete node from the graph. A subclass's destroy_node()
            # may need attributes that do not exist yet.
            Node.destroy_node(self)
            raise

    @cached_property
    def worker(self) -> Worker:
        """Runs long computations beside the callbacks; ends with the node."""
        return Worker(self)

    def destroy_node(self) -> None:
        """End the worker, then destroy the node."""
        if "worker" in vars(self):
            self.worker.close()
        super().destroy_node()

    def _set_up(self) -> None:
        self.params = self.declare_params()
        self._checked_params = self.params
        self._check_unknown_overrides()
        self.add_on_set_parameters_callback(self._check_params)
        self.add_post_set_parameters_callback(self._apply_params)
        self._arrivals_ns: dict[str, int] = {}
        # Of the inputs with a largest rate.
        self._selections: dict[str, StampSelection] = {}
        self._limited: dict[str, list[Subscription[Any]]] = defaultdict(list)
        self._dropped = DroppedInputs(self)
        backward = JumpThreshold(
            min_forward=None, min_backward=Duration(nanoseconds=-1)
        )
        self._clock.create_jump_callback(backward, post_callback=self._on_time_jump)
        self._timeouts_ns = {
            i.topic: None if i.timeout_s is None else round(i.timeout_s * 1e9)
            for i in self.inputs()
        }
        self.publishers_by_topic: dict[str, Publisher[Any]] = {
            output.topic: self.create_publisher(
                get_interface(output.type),
                output.topic,
                output.qos,
                other_types=[get_interface(each) for each in output.other_types],
            )
            for output in self.outputs()
        }
        for declared in self.inputs():
            self._subscribe(declared, self._receiver(declared))

    def declare_params(self) -> Any:
        """Declare PARAMS and return the values; extend for parameters beside them.

        The parameters of chosen methods are declared beside those of PARAMS.
        """
        chosen = {name: each.value for name, each in self._node_overrides.items()}
        return declare_params(self, with_methods(self.PARAMS, chosen))

    def inputs(self) -> tuple[Input, ...]:
        """Return INPUTS; override if topics or types depend on ``self.params``."""
        return self.INPUTS

    def outputs(self) -> tuple[Output, ...]:
        """Return OUTPUTS; override if topics or types depend on ``self.params``."""
        return self.OUTPUTS

    def publish(self, topic: str, msg: Any) -> None:
        """Publish on an output; ``topic`` is its name in OUTPUTS, before remapping."""
        self._output(topic).publish(msg)

    def hand_over(self, topic: str, msg: Any) -> None:
        """Publish a large message that this node does not change any more."""
        self._output(topic).hand_over(msg)

    def _output(self, topic: str) -> Publisher[Any]:
        publisher = self.publishers_by_topic.get(topic)
        if publisher is None:
            raise UnknownNameError.of("output", topic, list(self.publishers_by_topic))
        return publisher

    def has_listeners(self, topic: str) -> bool:
        return self.publishers_by_topic[topic].get_subscription_count() > 0

    def is_stale(self, topic: str) -> bool:
        """Whether an input never arrived, or not within its ``timeout_s``."""
        if topic not in self._timeouts_ns:
            raise UnknownNameError.of("input", topic, list(self._timeouts_ns))
        arrival_ns = self._arrivals_ns.get(topic)
        timeout_ns = self._timeouts_ns[topic]
        if arrival_ns is None or timeout_ns is None:
            return arrival_ns is None
        # Negative: the clock was set back, and the age is unknown.
        return not 0 <= self._clock.now_ns - arrival_ns <= timeout_ns

    @property
    def dropped_inputs(self) -> Mapping[tuple[str, str], int]:
        """Number of dropped messages by (topic, reason)."""
        return self._dropped.counts

    def drop_input(self, topic: str, error: InvalidInputError) -> None:
        """Count a message as dropped that turns out to be unusable after its callback.

        ``topic`` is its name in INPUTS.
        """
        self._dropped.add(topic, error)

    def on_input_dropped(self, topic: str, msg: Any, error: InvalidInputError) -> None:
        """Override to react to a message that was dropped, for example with a status.

        ``topic`` is its name in INPUTS.
        """

    def on_time_jump(self) -> None:
        """Override to reset the node after the clock jumped backward.

        This happens when a bag loops or a new run starts. All inputs are stale.
        """

    def on_params_changed(self, old: Any) -> None:
        """Override to react to new values of ``self.params``."""

    def change_rate(self, topic: str, most_hz: float) -> None:
        """Change ``most_hz`` of an input that has one."""
        self._selections[topic].rate_hz = most_hz
        for subscription in self._limited[topic]:
            subscription.limit_rate(most_hz)

    def _on_time_jump(self, jump: TimeJump) -> None:
        self._arrivals_ns.clear()
        self.on_time_jump()

    def _subscribe(self, declared: Input, receive: OnMessage) -> None:
        """Subscribe to each type of an input."""
        kinds = [get_interface(t) for t in (declared.type, *declared.other_types)]
        for kind in kinds:
            subscription: Subscription[Any] = self.create_subscription(
                kind,
                declared.topic,
                receive,
                declared.qos,
                shared=True,
                other_types=[other for other in kinds if other is not kind],
                ignore_local_publications=declared.ignores_own,
            )
            undecodable = InvalidInputError(
                "undecodable", f"its bytes are not a {type_name(kind)}"
            )
            if declared.most_hz < math.inf:
                subscription.limit_rate(declared.most_hz)
                self._limited[declared.topic].append(subscription)
            subscription.on_undecodable = partial(
                self._dropped.add, declared.topic, undecodable
            )

    def _receiver(self, declared: Input) -> OnMessage:
        callback = declared.callback
        if isinstance(callback, str):
            callback = getattr(self, callback)
        takes_info = takes_arguments(callback, 2)
        if declared.most_hz < math.inf:
            selection = StampSelection(declared.most_hz)
            self._selections[declared.topic] = selection
            callback = _selected(selection, callback)
        topic, arrivals = declared.topic, self._arrivals_ns
        shared = self.context.input_checks
        checks = {
            get_interface(each): shared.of(each, contents=declared.checks_contents)
            for each in (declared.type, *declared.other_types)
        }
        clock = self._clock

        def receive(msg: Any, *info: MessageInfo) -> Any:
            before_ns = arrivals.get(topic)
            try:
                check = checks[msg.__class__]
                if msg is not check.passed:
                    check(msg)
                arrivals[topic] = clock.now_ns
                return callback(msg, *info)
            except InvalidInputError as error:
                self._restore_arrival(topic, before_ns)
                self._dropped.add(topic, error)
                self.on_input_dropped(topic, msg, error)

        def receive_with_info(msg: Any, info: MessageInfo) -> Any:
            return receive(msg, info)

        return receive_with_info if takes_info else receive

    def _restore_arrival(self, topic: str, arrival_ns: int | None) -> None:
        if arrival_ns is None:
            self._arrivals_ns.pop(topic, None)
        else:
            self._arrivals_ns[topic] = arrival_ns

    def _check_unknown_overrides(self) -> None:
        for name, override in self._node_overrides.items():
            if not self.has_parameter(name) and not override.is_for_all:
                node = self.get_fully_qualified_name()
                see_all = f"navette param list {node}, while it runs"
                known = list(self._node_known_parameters() or [])
                raise ParameterError(
                    f"{override.origin}: node {node} has no parameter {name!r}"
                    f"{instead_of(name, known, see_all=see_all)}"
                )

    def _check_params(self, parameters: list[Parameter[Any]]) -> SetParametersResult:
        for parameter in parameters:
            if parameter.name in self.FIXED_AT_START:
                reason = f"parameter {parameter.name!r} cannot change after the start"
                return SetParametersResult(successful=False, reason=reason)
        own = {field.name for field in fields(self.params)}
        changes = {p.name: p.value for p in parameters if p.name in own}
        try:
            self._checked_params = self._changed_params(changes)
        except ParameterError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _changed_params(self, changes: dict[str, Any]) -> Any:
        """Return the parameters with changes; a new method brings its own fields.

        Raises:
            ParameterError: a value is not allowed.
        """
        registries = method_fields(self.PARAMS)
        present = {f.name: getattr(self.params, f.name) for f in fields(self.params)}
        chosen = {
            name: value
            for name, value in changes.items()
            if name in registries and value != present[name]
        }
        if not chosen:
            return dataclasses.replace(self.params, **changes)
        for name, value in chosen.items():
            # A peer on the network must not choose the files that this process runs.
            if not (isinstance(value, str) and registries[name].is_named(value)):
                known = ", ".join(registries[name])
                raise ParameterError(
                    f"parameter {name!r}: {value!r} is not a registered method (files "
                    f"and modules can be given at the start only); known: {known}"
                )
        values = present | changes
        kind = with_methods(self.PARAMS, values)
        names = {field.name for field in fields(kind)}
        return kind(**{k: v for k, v in values.items() if k in names})

    def _apply_params(self, parameters: list[Parameter[Any]]) -> None:
        old, self.params = self.params, self._checked_params
        if type(self.params) is not type(old):
            self._declare_methods(old)
        if self.params != old:
            self.on_params_changed(old)

    def _declare_methods(self, old: Params) -> None:
        """Replace the parameters of the previous methods by those of the new ones."""
        for name in own_fields(old, self.PARAMS):
            self.undeclare_parameter(name)
        self.params = declare_params(self, type(self.params))


def _selected(selection: StampSelection, callback: OnMessage) -> OnMessage:
    """Return a callback for messages of a header that skips those not selected."""
    takes = selection.takes

    def call(msg: Any, *info: MessageInfo) -> Any:
        return callback(msg, *info) if takes(stamp_to_ns(msg.header.stamp)) else None

    return call
