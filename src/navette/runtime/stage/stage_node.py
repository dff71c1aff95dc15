"""The base of every stage's node: topics and parameters declared as data."""

import dataclasses
from collections.abc import Callable, Collection
from dataclasses import dataclass
from typing import Any, ClassVar

from navette.errors import NavetteError, ParameterError, UnknownNameError
from navette.msgs import get_interface
from navette.msgs.rcl_interfaces.msg import SetParametersResult
from navette.params import Params
from navette.runtime.node import Node
from navette.runtime.parameter import Parameter
from navette.runtime.publisher import Publisher
from navette.runtime.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from navette.runtime.ros_clock import JumpThreshold, TimeJump
from navette.runtime.stage.params import declare_params
from navette.runtime.time import Duration


@dataclass(frozen=True, kw_only=True)
class _Topic:
    """A topic that a stage reads or writes."""

    topic: str
    type: str
    role: str
    #: How often it is expected, for docs and viewers; None = on events.
    rate_hz: float | None = None
    depth: int = 10
    #: Late joiners get the last samples (transient local).
    latched: bool = False
    best_effort: bool = False

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


@dataclass(frozen=True, kw_only=True)
class Input(_Topic):
    """What a stage reads; ``callback`` names the method that gets the message."""

    callback: str
    #: Older than this (by arrival, node's clock) counts as stale; None = never.
    timeout_s: float | None = None


@dataclass(frozen=True, kw_only=True)
class Output(_Topic):
    """What a stage writes."""


class StageNode(Node):
    """Declares PARAMS, subscribes INPUTS (shared: read-only), advertises OUTPUTS.

    Args:
        node_name: name in the graph.
        kwargs: as :class:`Node`.

    Raises:
        ParameterError: a value from outside is refused, or meant for this node and
            unknown; names the known ones.
    """

    PARAMS: ClassVar[type[Params]] = Params
    INPUTS: ClassVar[tuple[Input, ...]] = ()
    OUTPUTS: ClassVar[tuple[Output, ...]] = ()
    #: Parameters that are read at the start only; setting one later is refused.
    FIXED_AT_START: ClassVar[Collection[str]] = ()

    params: Any

    def __init__(self, node_name: str, **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        try:
            self._set_up()
        except NavetteError:
            # Leave no half-made node in the graph; the subclass's own way of ending
            # may need what it has not made yet.
            Node.destroy_node(self)
            raise

    def _set_up(self) -> None:
        self.params = declare_params(self, self.PARAMS)
        self._check_unknown_overrides()
        self.add_on_set_parameters_callback(self._check_params)
        self.add_post_set_parameters_callback(self._take_params)
        self._arrivals_ns: dict[str, int] = {}
        set_back = JumpThreshold(
            min_forward=None, min_backward=Duration(nanoseconds=-1)
        )
        self._clock.create_jump_callback(set_back, post_callback=self._on_time_jump)
        self._timeouts_ns = {
            i.topic: None if i.timeout_s is None else round(i.timeout_s * 1e9)
            for i in self.inputs()
        }
        self.publishers_by_topic: dict[str, Publisher[Any]] = {
            output.topic: self.create_publisher(
                get_interface(output.type), output.topic, output.qos
            )
            for output in self.OUTPUTS
        }
        for declared in self.inputs():
            self.create_subscription(
                get_interface(declared.type),
                declared.topic,
                self._noting_arrival(declared),
                declared.qos,
                shared=True,
            )

    def inputs(self) -> tuple[Input, ...]:
        """INPUTS; override where ``self.params`` chooses topics or types."""
        return self.INPUTS

    def publish(self, topic: str, msg: Any) -> None:
        """Publish on a declared output, by the name it has in OUTPUTS."""
        publisher = self.publishers_by_topic.get(topic)
        if publisher is None:
            raise UnknownNameError.of("output", topic, list(self.publishers_by_topic))
        publisher.publish(msg)

    def has_listeners(self, topic: str) -> bool:
        """Whether anybody reads a declared output."""
        return self.publishers_by_topic[topic].get_subscription_count() > 0

    def is_stale(self, topic: str) -> bool:
        """Whether an input never came, or not within its ``timeout_s``."""
        if topic not in self._timeouts_ns:
            raise UnknownNameError.of("input", topic, list(self._timeouts_ns))
        arrival_ns = self._arrivals_ns.get(topic)
        timeout_ns = self._timeouts_ns[topic]
        if arrival_ns is None or timeout_ns is None:
            return arrival_ns is None
        return self._clock.now_ns - arrival_ns > timeout_ns

    def on_time_jump(self) -> None:
        """Override to begin anew: the clock was set back (a bag loops, a run begins).

        What the inputs said before is of another time, and forgotten already.
        """

    def on_params_changed(self, old: Any) -> None:
        """Override to act on new values of ``self.params``."""

    def _on_time_jump(self, jump: TimeJump) -> None:
        self._arrivals_ns.clear()
        self.on_time_jump()

    def _noting_arrival(self, declared: Input) -> Callable[[Any], Any]:
        callback = getattr(self, declared.callback)
        topic, arrivals = declared.topic, self._arrivals_ns
        clock = self._clock

        def receive(msg: Any) -> Any:
            arrivals[topic] = clock.now_ns
            return callback(msg)

        return receive

    def _check_unknown_overrides(self) -> None:
        for name, override in self._overrides.items():
            if not self.has_parameter(name) and not override.is_for_all:
                known = ", ".join(sorted(self._store.values))
                raise ParameterError(
                    f"{override.origin}: node {self.get_fully_qualified_name()} has "
                    f"no parameter {name!r}; known: {known}"
                )

    def _check_params(self, parameters: list[Parameter[Any]]) -> SetParametersResult:
        for parameter in parameters:
            if parameter.name in self.FIXED_AT_START:
                reason = f"parameter {parameter.name!r} is read at the start only"
                return SetParametersResult(successful=False, reason=reason)
        try:
            self._changed(parameters)
        except ParameterError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _take_params(self, parameters: list[Parameter[Any]]) -> None:
        old, self.params = self.params, self._changed(parameters)
        if self.params != old:
            self.on_params_changed(old)

    def _changed(self, parameters: list[Parameter[Any]]) -> Any:
        own = {field.name for field in dataclasses.fields(self.PARAMS)}
        changes = {p.name: p.value for p in parameters if p.name in own}
        return dataclasses.replace(self.params, **changes)
