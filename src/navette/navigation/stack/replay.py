"""Replay of recorded inputs through nodes under virtual time.

The player publishes the bag's messages to the nodes under a virtual clock that starts
at the recording's time. Timers run, each message is processed completely before the
next, and the wall clock is not used: two replays write the same bytes.
"""

from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from navette.bags import BagTopic
from navette.bags.node import RecorderNode
from navette.bags.play import PlayOptions, Source
from navette.bags.play.node import PlayerNode
from navette.errors import InvalidValueError
from navette.msgs.topics import TF, TF_STATIC
from navette.navigation.stack.programs import MakeNode, default_context
from navette.navigation.stack.recorded_parameters import give_recorded_parameters
from navette.navigation.stack.scene import ResolvedScene
from navette.runtime import (
    Context,
    Executor,
    LoggingSeverity,
    Parameter,
    Stopwatch,
    VirtualClock,
)
from navette.runtime.overrides import ParameterOverrides
from navette.transports import EndpointKind

# Published by every node, independent of its function.
_OF_EVERY_NODE = ("/rosout", "/parameter_events")
# Subscribed on demand, possibly late.
_TRANSFORMS = (TF.name, TF_STATIC.name)


@dataclass(frozen=True)
class ReplaySummary:
    """Result of a replay."""

    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    fed: int
    recorded: int
    begin_ns: int
    duration_s: float
    wall_time_s: float


class Replay:
    """Nodes with inputs from a recording.

    Args:
        source: an open bag; the caller closes it.
        makers: create the nodes, each in the given context (which is also the default
            context meanwhile).
        record: new file for the nodes' outputs.
        overwrite: replace an existing recording.
        robot: its parameters apply, as far as the nodes have them. Without a robot,
            nodes use the recorded values, if available.
        arguments: ROS arguments, such as ``["--ros-args", "-p", "a:=1"]``.
        also: topics to replay although a node publishes or subscribes to them late.
        options: time range of the recording; the topics are chosen here.

    Raises:
        NavetteError: invalid parameter or topic, or no input was recorded.
    """

    def __init__(
        self,
        source: Source,
        makers: Sequence[MakeNode],
        *,
        record: Path | None = None,
        overwrite: bool = False,
        robot: ResolvedScene | None = None,
        arguments: Sequence[str] = (),
        also: Sequence[str] = (),
        options: PlayOptions | None = None,
    ) -> None:
        options = options or PlayOptions()
        begin_ns = source.start_ns + round(options.start_offset_s * 1e9)
        self.context = Context(clock=VirtualClock(max(0, begin_ns)))
        self._stack = ExitStack()
        with ExitStack() as making:
            making.callback(self.close)
            self._stack.callback(self.context.try_shutdown)
            give_recorded_parameters(self.context.overrides, source)
            if robot is not None:
                robot.override_parameters(self.context.overrides)
            given = len(self.context.overrides.sets)
            self.context.init(list(arguments), console_level=LoggingSeverity.WARN)
            with default_context(self.context):
                self.nodes = [make(self.context) for make in makers]
            by_user = ParameterOverrides()
            by_user.sets = self.context.overrides.sets[given:]
            by_user.check_used_by(self.nodes)
            self.outputs = self._topics_of(EndpointKind.PUBLISHER)
            self.inputs = self._choose_inputs(source, also)
            self.recorder = (
                None if record is None else self._record(record, overwrite=overwrite)
            )
            self.player = PlayerNode(
                source,
                _with_topics(options, self.inputs),
                context=self.context,
                node_name="replay",
            )
            self.executor = Executor(context=self.context)
            for node in self.context.nodes:
                self.executor.add_node(node)
            self._recorded = {topic.name for topic in source.topics}
            making.pop_all()

    @property
    def begin_ns(self) -> int:
        """First stamp of the range."""
        return self.player.player.begin_ns

    @property
    def end_ns(self) -> int:
        """Last stamp of the range."""
        return self.player.player.end_ns

    def shares(self, topic: BagTopic) -> bool:
        """Return whether other nodes published on a recorded topic of these, too."""
        own = self.context.graph.endpoints(topic.name, kind=EndpointKind.PUBLISHER)
        return len(topic.qos) > len(own)

    def run(self) -> ReplaySummary:
        """Replay from the first to the last stamp of the range.

        Raises:
            CallbackError: a node raised; names node, topic and stamp.
            FileFormatError: the recording could not be written.
        """
        watch = Stopwatch()
        self.player.start()
        self.executor.spin_until(self.end_ns)
        self._check_late_inputs()
        if self.recorder is not None:
            self.recorder.close()
            if self.recorder.error is not None:
                raise self.recorder.error
        progress = self.player.progress()
        return ReplaySummary(
            self.inputs,
            self.outputs,
            progress.published,
            0 if self.recorder is None else self.recorder.message_count,
            self.begin_ns,
            (progress.end_ns - progress.begin_ns) / 1e9,
            watch.elapsed_s,
        )

    def close(self) -> None:
        """Destroy the nodes and close the files; idempotent."""
        self._stack.close()

    def _topics_of(self, kind: EndpointKind) -> tuple[str, ...]:
        own = {node.get_fully_qualified_name() for node in self.nodes}
        found = {
            endpoint.topic
            for endpoint in self.context.graph.endpoints(kind=kind)
            if endpoint.node_full_name in own and endpoint.topic not in _OF_EVERY_NODE
        }
        return tuple(sorted(found))

    def _choose_inputs(self, source: Source, also: Sequence[str]) -> tuple[str, ...]:
        subscribed = set(self._topics_of(EndpointKind.SUBSCRIPTION))
        wanted = (subscribed.union(_TRANSFORMS) - set(self.outputs)) | set(also)
        recorded = dict.fromkeys(_full(topic.name) for topic in source.topics)
        chosen = tuple(name for name in recorded if name in wanted)
        if not subscribed.union(also).intersection(chosen):
            raise InvalidValueError(
                "no input was recorded: the nodes read "
                f"{', '.join(sorted(subscribed)) or 'nothing'}; "
                f"the bag has {', '.join(recorded) or 'nothing'}"
            )
        return chosen

    def _check_late_inputs(self) -> None:
        """Warn of recorded topics that were subscribed to after the start."""
        late = set(self._topics_of(EndpointKind.SUBSCRIPTION)) & self._recorded
        for topic in sorted(late - set(self.inputs) - set(self.outputs)):
            self.player.get_logger().warning(
                f"{topic} was subscribed to after the start and not replayed; "
                f"add --input {topic}"
            )

    def _record(self, path: Path, *, overwrite: bool) -> RecorderNode:
        if not self.outputs:
            names = ", ".join(node.get_name() for node in self.nodes)
            raise InvalidValueError(f"nothing to record: {names} publishes nothing")
        topics: Parameter[Any] = Parameter("topics", value=list(self.outputs))
        recorder = RecorderNode(
            path,
            overwrite=overwrite,
            context=self.context,
            parameter_overrides=[topics],
        )
        self._stack.callback(recorder.close)
        return recorder


def _with_topics(options: PlayOptions, topics: tuple[str, ...]) -> PlayOptions:
    return PlayOptions(
        topics=topics,
        start_offset_s=options.start_offset_s,
        duration_s=options.duration_s,
    )


def _full(name: str) -> str:
    return f"/{name.lstrip('/')}"
