"""The node ``recorder``: writes what is said on the topics into a bag.

It subscribes to every chosen topic as soon as the graph shows it, with queues that
lose nothing, and writes each message at the node clock's time. Chunks end by size
and by a timer on the same clock, so that the same run gives the same bytes, and a
killed process loses at most ``flush_period_s`` of the robot's time.
"""

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from navette.bags.params import RecorderParams
from navette.bags.qos import OfferedQos, qos_text
from navette.bags.writer import BagWriter
from navette.errors import FileFormatError, UnknownNameError
from navette.msgs import definition_text, get_interface, serialize, type_hash
from navette.params import Params
from navette.runtime.context import Context
from navette.runtime.parameter import Parameter
from navette.runtime.qos import (
    QoSDurabilityPolicy,
    QoSHistoryPolicy,
    QoSLivelinessPolicy,
    QoSProfile,
    QoSReliabilityPolicy,
)
from navette.runtime.stage import StageNode
from navette.runtime.timer import Timer

if TYPE_CHECKING:
    from navette.transports import Endpoint

# Takes what any publisher offers, latched messages too, and drops nothing.
_QOS = QoSProfile(
    history=QoSHistoryPolicy.KEEP_ALL,
    reliability=QoSReliabilityPolicy.BEST_AVAILABLE,
    durability=QoSDurabilityPolicy.BEST_AVAILABLE,
    liveliness=QoSLivelinessPolicy.BEST_AVAILABLE,
)


class RecorderNode(StageNode):
    """Records from its making until :meth:`close`.

    A disk that fills up ends the recording, with an error in the log and in
    :attr:`error`; the robot keeps driving.

    Args:
        path: the ``.mcap`` file; one that exists is replaced.

    Raises:
        FileFormatError: the file cannot be made; names path and reason.
    """

    PARAMS: ClassVar[type[Params]] = RecorderParams
    params: RecorderParams

    def __init__(
        self,
        path: Path | str,
        *,
        context: Context | None = None,
        parameter_overrides: Sequence[Parameter[Any]] | None = None,
    ) -> None:
        self.path = Path(path)
        #: What ended the recording early, if anything did.
        self.error: FileFormatError | None = None
        self._writer: BagWriter | None = None
        self._stop_listening: Callable[[], None] = _nothing
        super().__init__(
            "recorder", context=context, parameter_overrides=parameter_overrides
        )
        try:
            self._writer = BagWriter(self.path)
        except FileFormatError:
            self.destroy_node()
            raise
        self._recorded: set[tuple[str, str]] = set()
        self._message_count = 0
        self._refreshing = False
        self._flush_timer = self._new_flush_timer()
        self._stop_listening = self.context.graph.on_change(self._on_graph_change)
        self._refresh()

    @property
    def message_count(self) -> int:
        """Messages recorded so far."""
        return self._message_count

    def close(self) -> None:
        """Finish the file and leave the graph; twice is harmless."""
        self.destroy_node()

    def destroy_node(self) -> None:
        self._stop_listening()
        self._stop_listening = _nothing
        super().destroy_node()
        if self._writer is not None:
            self._on_disk(self._writer.close)
            self._writer = None

    def on_params_changed(self, old: RecorderParams) -> None:
        """More topics are taken up at once; those recorded already stay."""
        if self.params.flush_period_s != old.flush_period_s:
            self.destroy_timer(self._flush_timer)
            self._flush_timer = self._new_flush_timer()
        self._refresh()

    # -- which topics ----------------------------------------------------------

    def _on_graph_change(self) -> None:
        """Called from within a change, maybe of many: look once, and later."""
        if not self._refreshing:
            self._refreshing = True
            self.context.loop.call_soon_threadsafe(
                self._refresh, "recorder graph", self.get_fully_qualified_name()
            )

    def _refresh(self) -> None:
        self._refreshing = False
        if self._writer is None:
            return
        selection = self.params.selection
        for topic, type_names in self.context.graph.topics().items():
            for type_name in type_names:
                key = topic, type_name
                if key not in self._recorded and selection.takes(topic, type_name):
                    self._recorded.add(key)
                    self._record_topic(topic, type_name)

    def _record_topic(self, topic: str, type_name: str) -> None:
        try:
            message_type = get_interface(type_name)
            definition = definition_text(type_name)
        except UnknownNameError as error:
            self.get_logger().warning(f"cannot record {topic}: {error}")
            return
        recording = _Channel(topic, type_name, definition)
        self.create_subscription(
            message_type, topic, partial(self._record, recording), _QOS, shared=True
        )

    def _announce(self, writer: BagWriter, channel: "_Channel") -> int:
        """At the first message: its publishers, and what they offer, are known."""
        endpoints = self.context.graph.endpoints(channel.topic)
        offers = [_offer(e) for e in endpoints if e.kind.name == "PUBLISHER"]
        return writer.add_channel(
            channel.topic,
            channel.type_name,
            channel.definition,
            type_hash=type_hash(channel.type_name),
            qos=qos_text(offers),
        )

    # -- what is said ----------------------------------------------------------

    def _record(self, channel: "_Channel", message: Any) -> None:
        if self._writer is not None:
            self._on_disk(partial(self._write, self._writer, channel, message))

    def _write(self, writer: BagWriter, channel: "_Channel", message: Any) -> None:
        if channel.number is None:
            channel.number = self._announce(writer, channel)
        writer.write(channel.number, self._clock.now_ns, serialize(message))
        self._message_count += 1

    def _new_flush_timer(self) -> Timer:
        return self.create_timer(self.params.flush_period_s, self._flush)

    def _flush(self) -> None:
        if self._writer is not None:
            self._on_disk(self._writer.flush)

    def _on_disk(self, work: Callable[[], None]) -> None:
        """Do ``work``; a disk that fails ends the recording, not the run."""
        try:
            work()
        except OSError as error:
            assert self._writer is not None, "without a file there is no work"
            self._writer.abandon()
            self._writer = None
            reason = error.strerror or str(error)
            self.error = FileFormatError(self.path, f"recording ended: {reason}")
            self.get_logger().error(str(self.error))


class _Channel:
    """A recorded topic; ``number`` is its channel in the file once it has one."""

    __slots__ = ("definition", "number", "topic", "type_name")

    def __init__(self, topic: str, type_name: str, definition: str) -> None:
        self.topic = topic
        self.type_name = type_name
        self.definition = definition
        self.number: int | None = None


def _offer(endpoint: "Endpoint") -> OfferedQos:
    qos = endpoint.qos
    return OfferedQos(
        history=qos.history.short_key,
        depth=qos.depth,
        reliability=qos.reliability.short_key,
        durability=qos.durability.short_key,
        deadline_ns=qos.deadline_ns,
        lifespan_ns=qos.lifespan_ns,
        liveliness=qos.liveliness.short_key,
        lease_ns=qos.lease_ns,
    )


def _nothing() -> None:
    """Nobody is listened to."""
