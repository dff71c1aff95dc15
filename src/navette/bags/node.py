"""The node ``recorder``: record topics into a bag.

The node subscribes to every selected topic as soon as it appears in the graph, with
unbounded queues, and writes each message with the time of the node's clock. Chunks end
by size and by a timer of the same clock, so that the same run produces the same bytes,
and a killed process loses at most ``flush_period_s`` of the robot's time.
"""

from collections import deque
from collections.abc import Callable, Collection, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, ClassVar

from navette.bags.bag import BagTopic
from navette.bags.params import RecorderParams
from navette.bags.qos_profiles import offer_of
from navette.bags.recording import (
    RecordedTopic,
    Recording,
    SingleFile,
    Snapshots,
    SplitFiles,
)
from navette.bags.replacing import make_way
from navette.errors import FileFormatError, UnknownNameError
from navette.msgs import definition_text, get_interface, type_hash
from navette.msgs.std_srvs.srv import SetBool, Trigger
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
from navette.runtime.ros_clock import Clock
from navette.runtime.stage.stage_node import StageNode
from navette.runtime.subscription import Subscription
from navette.runtime.time import ClockType
from navette.runtime.timer import Timer

# Compatible with every publisher, receives latched messages, drops nothing.
_QOS = QoSProfile(
    history=QoSHistoryPolicy.KEEP_ALL,
    reliability=QoSReliabilityPolicy.BEST_AVAILABLE,
    durability=QoSDurabilityPolicy.BEST_AVAILABLE,
    liveliness=QoSLivelinessPolicy.BEST_AVAILABLE,
)


_MOST_EARLY = 1000
"""Maximum number of messages stored before simulated time begins."""


class RecorderNode(StageNode):
    """Records from construction until :meth:`close`.

    A full disk ends the recording, with an error in the log and in :attr:`error`; the
    robot continues. Services: ``~/pause`` (SetBool) and, with snapshots,
    ``~/snapshot`` (Trigger), which writes the last seconds.

    Args:
        path: the new ``.mcap`` file. For split files and snapshots: a new folder.
        overwrite: replace an existing bag that no other process records.

    Raises:
        FileFormatError: the file cannot be created, or has another suffix; names path
            and reason.
    """

    PARAMS: ClassVar[type[Params]] = RecorderParams
    FIXED_AT_START: ClassVar[Collection[str]] = (
        "compression",
        "max_bag_size_bytes",
        "max_bag_duration_s",
        "snapshot_duration_s",
        "snapshot_bytes",
    )
    params: RecorderParams

    def __init__(
        self,
        path: Path | str,
        *,
        overwrite: bool = False,
        context: Context | None = None,
        parameter_overrides: Sequence[Parameter[Any]] | None = None,
    ) -> None:
        self.path = Path(path)
        #: The error that ended the recording, or None.
        self.error: FileFormatError | None = None
        self._recording: Recording | None = None
        self._stop_listening: Callable[[], None] = _nothing
        super().__init__(
            "recorder", context=context, parameter_overrides=parameter_overrides
        )
        try:
            self._recording = _open(self.path, self.params, overwrite=overwrite)
        except FileFormatError:
            self.destroy_node()
            raise
        self._recorded: set[tuple[str, str]] = set()
        self._queues: list[tuple[Subscription[Any], RecordedTopic]] = []
        #: Selected topics whose type is not defined yet.
        self.undefined: dict[str, str] = {}
        self.message_count = 0
        #: Bytes of the messages recorded so far, before compression.
        self.payload_bytes = 0
        self._refreshing = False
        self._early: deque[tuple[RecordedTopic, bytes]] = deque(maxlen=_MOST_EARLY)
        self._flush_timer = self._new_flush_timer()
        self.create_service(SetBool, "~/pause", self._on_pause)
        if isinstance(self._recording, Snapshots):
            self.create_service(Trigger, "~/snapshot", self._on_snapshot)
        self._stop_listening = self.context.graph.on_change(self._on_graph_change)
        self.refresh()

    @property
    def topics(self) -> list[str]:
        return sorted({topic for topic, _ in self._recorded} - self.undefined.keys())

    def close(self) -> None:
        """Finish the file and leave the graph; a second call has no effect."""
        self.destroy_node()

    def destroy_node(self) -> None:
        self._stop_listening()
        self._stop_listening = _nothing
        super().destroy_node()
        if self._recording is not None:
            self._on_disk(self._recording.close)
            self._recording = None

    def on_params_changed(self, old: RecorderParams) -> None:
        """Record newly selected topics at once; topics already recorded stay."""
        if self.params.flush_period_s != old.flush_period_s:
            self.destroy_timer(self._flush_timer)
            self._flush_timer = self._new_flush_timer()
        self.refresh()

    # -- topics ----------------------------------------------------------------

    def _on_graph_change(self) -> None:
        """Schedule one update for any number of graph changes."""
        if not self._refreshing:
            self._refreshing = True
            self.context.loop.call_soon_threadsafe(
                self.refresh, "recorder graph", self.get_fully_qualified_name()
            )

    def refresh(self) -> None:
        """Subscribe to topics that are new, or whose type has become known."""
        self._refreshing = False
        if self._recording is None:
            return
        selection = self.params.selection
        for topic, type_names in self.context.graph.topics().items():
            for type_name in type_names:
                key = topic, type_name
                is_new = key not in self._recorded or topic in self.undefined
                if is_new and selection.takes(topic, type_name):
                    self._record_topic(topic, type_name, type_names)

    def _record_topic(self, topic: str, type_name: str, all_types: list[str]) -> None:
        is_first = (topic, type_name) not in self._recorded
        self._recorded.add((topic, type_name))
        try:
            message_type = get_interface(type_name)
            definition = definition_text(type_name)
        except UnknownNameError as error:
            self.undefined[topic] = type_name
            if is_first:
                self.get_logger().warning(f"cannot record {topic}: {error}")
            return
        self.undefined.pop(topic, None)
        recorded = RecordedTopic(
            BagTopic(topic, type_name, definition, type_hash(type_name))
        )
        subscription: Subscription[Any] = self.create_subscription(
            message_type,
            topic,
            partial(self._record, recorded),
            _QOS,
            raw=True,  # messages of other processes are serialized already
            shared=True,
            other_types=[each for each in all_types if each != type_name],
        )
        self._queues.append((subscription, recorded))

    def _announce(self, recorded: RecordedTopic) -> None:
        """Register a topic at its first message, when its publishers' QoS is known."""
        endpoints = self.context.graph.endpoints(recorded.topic.name)
        # Ids of endpoints of other processes are random.
        endpoints.sort(key=lambda endpoint: endpoint.node_full_name)
        offers = tuple(
            offer_of(QoSProfile.from_endpoint_qos(e.qos))
            for e in endpoints
            if e.kind.name == "PUBLISHER"
        )
        recorded.topic = replace(recorded.topic, qos=offers)

    # -- messages --------------------------------------------------------------

    def _record(self, recorded: RecordedTopic, payload: bytes) -> None:
        if self._recording is None or self.params.paused:
            return
        if self._waits_for_clock(recorded, payload):
            return
        if recorded.count == 0:
            self._announce(recorded)
        recorded.count += 1
        self.message_count += 1
        self.payload_bytes += len(payload)
        try:
            self._recording.write(recorded, self._clock.now_ns, payload)
        except (OSError, FileFormatError) as error:
            self._end_early(error)

    def record_queued(self) -> None:
        """Record what was received but waits for its callback: the end of a recording.

        A recorder that is slower than the publishers would lose it unseen.
        """
        for subscription, recorded in self._queues:
            while (taken := subscription.take_with_info(raw=True)) is not None:
                self._record(recorded, taken[0])

    def _waits_for_clock(self, recorded: RecordedTopic, payload: bytes) -> bool:
        """Store a message received before the first simulated time, without a stamp."""
        if not self._clock.ros_time_is_active:
            return False
        if self._clock.now_ns == 0:
            self._early.append((recorded, payload))
            return True
        early, self._early = self._early, deque(maxlen=_MOST_EARLY)
        for each in early:
            self._record(*each)
        return False

    def _new_flush_timer(self) -> Timer:
        # Simulated time may stop; received messages must reach the disk anyway.
        clock = None
        if self._clock.ros_time_is_active:
            clock = Clock(clock_type=ClockType.STEADY_TIME, context=self.context)
        return self.create_timer(self.params.flush_period_s, self._flush, clock=clock)

    def _flush(self) -> None:
        if self._recording is not None:
            self._on_disk(self._recording.flush)

    def take_snapshot(self) -> Path | None:
        """Write the last seconds to a new file; None if there are no messages.

        Raises:
            FileFormatError: this recorder takes no snapshots, or the disk is full.
        """
        if not isinstance(self._recording, Snapshots):
            raise FileFormatError(
                self.path, "this recorder takes no snapshots (see snapshot_duration_s)"
            )
        try:
            return self._recording.take()
        except OSError as error:
            reason = error.strerror or str(error)
            raise FileFormatError(self.path, f"no snapshot: {reason}") from error

    def _on_snapshot(self, request: Any, response: Any) -> Any:
        try:
            path = self.take_snapshot()
        except FileFormatError as error:
            self.get_logger().error(str(error))
            response.message = str(error)
            return response
        response.success = path is not None
        response.message = "no message was received" if path is None else str(path)
        self.get_logger().info(f"snapshot: {response.message}")
        return response

    def _on_pause(self, request: Any, response: Any) -> Any:
        self.set_parameters([Parameter("paused", value=request.data)])
        response.success = True
        response.message = "paused" if request.data else "recording"
        return response

    def _on_disk(self, work: Callable[[], None]) -> None:
        """Run ``work``; a disk error ends the recording, not the run."""
        try:
            work()
        except (OSError, FileFormatError) as error:
            self._end_early(error)

    def _end_early(self, error: OSError | FileFormatError) -> None:
        assert self._recording is not None, "the recorder has a file"
        self._recording.abandon()
        self._recording = None
        reason = getattr(error, "strerror", None) or str(error)
        self.error = FileFormatError(self.path, f"recording ended: {reason}")
        self.get_logger().error(str(self.error))


def _open(path: Path, params: RecorderParams, *, overwrite: bool) -> Recording:
    in_folder = params.snapshot_duration_s or (
        params.max_bag_size_bytes or params.max_bag_duration_s
    )
    if in_folder:
        make_way(path, overwrite=overwrite)
    if params.snapshot_duration_s:
        return Snapshots(
            path,
            duration_ns=round(params.snapshot_duration_s * 1e9),
            max_bytes=params.snapshot_bytes,
            compression=params.compression,
        )
    if params.max_bag_size_bytes or params.max_bag_duration_s:
        return SplitFiles(
            path,
            compression=params.compression,
            max_size=params.max_bag_size_bytes,
            max_duration_ns=round(params.max_bag_duration_s * 1e9),
        )
    if path.suffix != ".mcap":
        raise FileFormatError(
            path,
            "a recording is MCAP: use a name that ends in .mcap; navette bag convert "
            "writes other formats",
        )
    return SingleFile(path, compression=params.compression, overwrite=overwrite)


def _nothing() -> None:
    """No graph subscription to end."""
