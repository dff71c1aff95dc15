"""Recorded inputs through nodes in lock-step: what would they have said?

The nodes are fed from the bag by the player, under a virtual clock that starts at the
recording's time: their timers run, a message and all that follows from it is done
before the next, and no wall clock is asked. So two replays write the same bytes.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from navette.bags.node import RecorderNode
from navette.bags.play import PlayOptions, Source
from navette.bags.play.node import PlayerNode
from navette.errors import InvalidValueError
from navette.navigation.stack.recorded_parameters import give_recorded_parameters
from navette.runtime import (
    Context,
    Executor,
    LoggingSeverity,
    Node,
    Parameter,
    Stopwatch,
    VirtualClock,
)
from navette.runtime.context import Scope, current_scope
from navette.runtime.overrides import ParameterOverrides
from navette.topics import TF, TF_STATIC
from navette.transports import EndpointKind

MakeNode = Callable[[Context], Node]

# Said by every node about itself: no result of its work.
_OWN_AFFAIRS = ("/rosout", "/parameter_events")
# Listened to when it is needed, maybe late.
_TRANSFORMS = (TF.name, TF_STATIC.name)


@dataclass(frozen=True)
class ReplaySummary:
    """What came of a replay."""

    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    fed: int
    recorded: int
    begin_ns: int
    duration_s: float
    wall_time_s: float


class Replay:
    """Nodes that are fed from a recording.

    Args:
        source: an open bag; stays the caller's to close.
        makers: make the nodes, each in the context that it is given (which is also
            the default one while they are made).
        record: where the nodes' outputs go.
        overrides: gives parameters that need not reach a node (a robot's). Without
            any, nodes have those with which they were recorded, if that is known.
        arguments: ROS arguments, such as ``["--ros-args", "-p", "a:=1"]``.
        also: topics to feed although a node says them itself, or asks for them late.
        options: the part of the recording; its topics are chosen here.

    Raises:
        NavetteError: a parameter or a topic is wrong, or no input was recorded.
    """

    def __init__(
        self,
        source: Source,
        makers: Sequence[MakeNode],
        *,
        record: Path | None = None,
        overrides: Callable[[ParameterOverrides], None] = lambda overrides: None,
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
            overrides(self.context.overrides)
            given = len(self.context.overrides.sets)
            self.context.init(list(arguments), console_level=LoggingSeverity.WARN)
            with _default_context(self.context):
                self.nodes = [make(self.context) for make in makers]
            by_user = ParameterOverrides()
            by_user.sets = self.context.overrides.sets[given:]
            by_user.check_used_by(self.nodes)
            self.outputs = self._topics_of(EndpointKind.PUBLISHER)
            self.inputs = self._choose_inputs(source, also)
            self.recorder = None if record is None else self._record(record)
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
        """First stamp of the part."""
        return self.player.player.begin_ns

    @property
    def end_ns(self) -> int:
        """Last stamp of the part."""
        return self.player.player.end_ns

    def run(self) -> ReplaySummary:
        """From the first to the last stamp of the part.

        Raises:
            CallbackError: a node raised; names node, topic and stamp.
            FileFormatError: the disk refused the recording.
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
        """End nodes and files; twice is harmless."""
        self._stack.close()

    # -- who says and hears what -----------------------------------------------

    def _topics_of(self, kind: EndpointKind) -> tuple[str, ...]:
        own = {node.get_fully_qualified_name() for node in self.nodes}
        found = {
            endpoint.topic
            for endpoint in self.context.graph.endpoints(kind=kind)
            if endpoint.node_full_name in own and endpoint.topic not in _OWN_AFFAIRS
        }
        return tuple(sorted(found))

    def _choose_inputs(self, source: Source, also: Sequence[str]) -> tuple[str, ...]:
        heard = set(self._topics_of(EndpointKind.SUBSCRIPTION))
        wanted = (heard.union(_TRANSFORMS) - set(self.outputs)) | set(also)
        recorded = dict.fromkeys(_full(topic.name) for topic in source.topics)
        chosen = tuple(name for name in recorded if name in wanted)
        if not heard.union(also).intersection(chosen):
            raise InvalidValueError(
                "no input was recorded: the nodes read "
                f"{', '.join(sorted(heard)) or 'nothing'}; "
                f"the bag has {', '.join(recorded) or 'nothing'}"
            )
        return chosen

    def _check_late_inputs(self) -> None:
        """What was recorded and asked for later on was not fed: say so."""
        late = set(self._topics_of(EndpointKind.SUBSCRIPTION)) & self._recorded
        for topic in sorted(late - set(self.inputs) - set(self.outputs)):
            self.player.get_logger().warning(
                f"{topic} was subscribed to after the start and not fed; "
                f"--input {topic} feeds it"
            )

    def _record(self, path: Path) -> RecorderNode:
        if not self.outputs:
            names = ", ".join(node.get_name() for node in self.nodes)
            raise InvalidValueError(f"nothing to record: {names} publishes nothing")
        topics: Parameter[Any] = Parameter("topics", value=list(self.outputs))
        recorder = RecorderNode(
            path, context=self.context, parameter_overrides=[topics]
        )
        self._stack.callback(recorder.close)
        return recorder


@contextmanager
def _default_context(context: Context) -> Iterator[None]:
    """Nodes of programs take the default context: let it be this one."""
    token = current_scope.set(Scope(context.graph, default=context))
    try:
        yield
    finally:
        current_scope.reset(token)


def _with_topics(options: PlayOptions, topics: tuple[str, ...]) -> PlayOptions:
    return PlayOptions(
        topics=topics,
        start_offset_s=options.start_offset_s,
        duration_s=options.duration_s,
    )


def _full(name: str) -> str:
    return f"/{name.lstrip('/')}"
