"""``navette bag record``: record topics to a file."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import click

from navette.cli.completing import complete_topics
from navette.cli.completing_installed import complete_messages
from navette.cli.options import Argument, Option
from navette.cli.session import FAILED
from navette.cli.stderr import note

if TYPE_CHECKING:
    from navette.bags.node import RecorderNode
    from navette.bags.selection import TopicSelection
    from navette.runtime import Node

TopicNames = Annotated[
    list[str] | None,
    Argument(
        metavar="[TOPIC]...",
        help="Record these topics.",
        complete=complete_topics,
    ),
]
All = Annotated[
    bool, Option("--all", "-a", help="Record all topics, including raw images.")
]
Regex = Annotated[
    str, Option("--regex", "-e", metavar="PATTERN", help="Record matching topics.")
]
TopicTypes = Annotated[
    list[str] | None,
    Option(
        "--topic-types",
        metavar="TYPE...",
        takes_words=True,
        help="Record topics of these types.",
        complete=complete_messages,
    ),
]
Exclude = Annotated[
    str,
    Option(
        "--exclude-regex",
        "--exclude",
        "-x",
        metavar="PATTERN",
        help="Omit matching topics.",
    ),
]
ExcludeTopics = Annotated[
    list[str] | None,
    Option(
        "--exclude-topics",
        metavar="TOPIC...",
        takes_words=True,
        help="Omit these topics.",
        complete=complete_topics,
    ),
]
ExcludeTypes = Annotated[
    list[str] | None,
    Option(
        "--exclude-topic-types",
        metavar="TYPE...",
        takes_words=True,
        help="Omit topics of these types.",
        complete=complete_messages,
    ),
]
Hidden = Annotated[
    bool,
    Option("--include-hidden-topics", help="Include hidden topics, such as /_action/…"),
]
Output = Annotated[
    str,
    Option(
        "--output",
        "-o",
        metavar="NAME",
        help="Write NAME.mcap, or a folder NAME if the bag is split. Default: a date.",
    ),
]
Overwrite = Annotated[
    bool, Option("--overwrite", help="Replace an existing recording.")
]
MaxSize = Annotated[
    int,
    Option("--max-bag-size", "-b", metavar="BYTES", min=0, help="Split at this size."),
]
MaxDuration = Annotated[
    float,
    Option(
        "--max-bag-duration", "-d", metavar="S", min=0, help="Split every S seconds."
    ),
]
Snapshot = Annotated[
    float,
    Option(
        "--snapshot-duration",
        metavar="S",
        min=0,
        help="Keep the last S seconds in memory; write them on key s or a call of"
        " /recorder/snapshot.",
    ),
]
Compression = Annotated[
    str, Option(metavar="KIND", help="Compression of the chunks: zstd, lz4 or none.")
]
SimTime = Annotated[
    bool, Option("--use-sim-time", help="Stamp with /clock instead of system time.")
]
Paused = Annotated[
    bool,
    Option("--start-paused", "--paused", help="Start paused; space resumes."),
]


def record(
    topics: TopicNames = None,
    all_: All = False,
    regex: Regex = "",
    topic_types: TopicTypes = None,
    exclude: Exclude = "",
    exclude_topics: ExcludeTopics = None,
    exclude_topic_types: ExcludeTypes = None,
    include_hidden_topics: Hidden = False,
    output: Output = "",
    overwrite: Overwrite = False,
    max_bag_size: MaxSize = 0,
    max_bag_duration: MaxDuration = 0.0,
    snapshot_duration: Snapshot = 0.0,
    compression: Compression = "zstd",
    use_sim_time: SimTime = False,
    paused: Paused = False,
) -> None:
    """Record topics to a bag, until Ctrl-C.

    Topics that appear later are included. Keys: space pauses and resumes, s writes a
    snapshot, q quits.
    """
    from navette.msgs.registry import full_name

    if not (topics or all_ or regex or topic_types):
        raise click.UsageError("give topics, --all, --regex or --topic-types")
    selection = _selection(topics or (), regex, topic_types or (), all_=all_)
    patterns = [exclude] if exclude else []
    patterns += [f"^{re.escape(_full(each))}$" for each in exclude_topics or ()]
    in_folder = bool(max_bag_size or max_bag_duration or snapshot_duration)
    path = _path(output, in_folder=in_folder)
    if path.exists() and not overwrite:
        from navette.errors import FileFormatError

        raise FileFormatError(path, "already exists; --overwrite replaces it")
    parameters: dict[str, Any] = {
        "topics": list(selection.topics),
        "types": list(selection.types),
        "regex": selection.regex,
        "exclude": "|".join(patterns),
        "exclude_types": list(map(full_name, exclude_topic_types or ())),
        "images": True,
        "hidden": include_hidden_topics,
        "compression": compression,
        "max_bag_size_bytes": max_bag_size,
        "max_bag_duration_s": max_bag_duration,
        "snapshot_duration_s": snapshot_duration,
        "paused": paused,
        "use_sim_time": use_sim_time,
    }
    raise click.exceptions.Exit(_record(path, parameters, overwrite=overwrite))


def _selection(
    topics: Sequence[str], regex: str, types: Sequence[str], *, all_: bool
) -> "TopicSelection":
    """Return the topics to record; ``--all`` overrides the others, as in ROS 2."""
    from navette.bags.selection import TopicSelection
    from navette.msgs.registry import full_name

    selection = TopicSelection(
        tuple(map(_full, topics)), regex, types=tuple(map(full_name, types))
    )
    if not all_:
        return selection
    if topics or regex or types:
        note("--all records every topic: TOPIC, --regex, --topic-types have no effect")
    return TopicSelection()


def _full(topic: str) -> str:
    from navette.runtime.names import validate_full_topic_name

    full = topic if topic.startswith("/") else f"/{topic}"
    validate_full_topic_name(full)
    return full


def _path(output: str, *, in_folder: bool) -> Path:
    """Return the path of the bag: a folder, or a file with the suffix."""
    path = Path(output or _dated())
    if in_folder:
        path = path.with_suffix("") if path.suffix == ".mcap" else path
    elif path.suffix != ".mcap":
        path = path.with_name(f"{path.name}.mcap")
    return path


def _dated() -> str:
    from datetime import UTC, datetime

    from navette.runtime import SystemClock

    now = datetime.fromtimestamp(SystemClock().now_ns / 1e9, UTC).astimezone()
    return now.strftime("navette_%Y_%m_%d-%H_%M_%S")


def _record(path: Path, parameters: dict[str, Any], *, overwrite: bool) -> int:
    from contextlib import ExitStack

    from navette.bags.node import RecorderNode
    from navette.cli.bag.record_screen import RecordScreen
    from navette.cli.keyboard import listening_to_keys
    from navette.cli.session import connect
    from navette.runtime import Parameter

    overrides: list[Parameter[Any]] = [
        Parameter(name, value=value) for name, value in parameters.items()
    ]
    with connect() as node, ExitStack() as stack:
        recorder = RecorderNode(
            path,
            overwrite=overwrite,
            context=node.context,
            parameter_overrides=overrides,
        )
        stack.callback(recorder.close)
        node.executor.add_node(recorder)
        session = _Session(node, recorder)
        screen = RecordScreen(recorder)
        keys = stack.enter_context(listening_to_keys(session.on_key))
        try:
            with screen.watching(keys=keys):
                session.run()
        except KeyboardInterrupt:
            pass  # a normal end of a recording
        recorder.record_queued()
        recorder.close()
        screen.report()
        return FAILED if recorder.error is not None else 0


class _Session:
    """Run the recorder until key q or an error."""

    def __init__(self, node: "Node", recorder: "RecorderNode") -> None:
        self._node = node
        self._recorder = recorder
        self._requested: set[str] = set()
        self._is_over = False

    def run(self) -> None:
        """Record; request unknown type definitions from their publishers."""
        from navette.cli.session import wait_for

        while not self._is_over and self._recorder.error is None:
            wait_for(self._node, self._needs_attention)
            for topic in self._undefined():
                self._requested.add(topic)
                self._fetch(topic, self._recorder.undefined[topic])

    def _needs_attention(self) -> bool:
        return (
            self._is_over or self._recorder.error is not None or bool(self._undefined())
        )

    def _undefined(self) -> list[str]:
        undefined = self._recorder.undefined
        return [each for each in undefined if each not in self._requested]

    def _fetch(self, topic: str, type_name: str) -> None:
        from navette.cli.peer_definitions import fetch_definition
        from navette.errors import NavetteError
        from navette.msgs import register_definition
        from navette.transports import EndpointKind

        graph = self._node.context.graph
        for endpoint in graph.endpoints(topic, kind=EndpointKind.PUBLISHER):
            found = fetch_definition(self._node, endpoint.node_full_name, type_name)
            if found.text is None:
                continue
            try:
                register_definition(type_name, found.text)
            except NavetteError as error:
                note(f"cannot record {topic}: {error}")
            else:
                self._recorder.refresh()
                return

    def on_key(self, key: str) -> None:
        """Handle a key; called from the keyboard thread."""
        act = {" ": self._toggle, "s": self._snapshot, "q": self._end}.get(key)
        if act is not None:
            loop = self._node.context.loop
            loop.call_soon_threadsafe(act, "keyboard", "recorder")

    def _toggle(self) -> None:
        from navette.runtime import Parameter

        paused = not self._recorder.params.paused
        self._recorder.set_parameters([Parameter("paused", value=paused)])

    def _snapshot(self) -> None:
        from navette.errors import FileFormatError

        try:
            path = self._recorder.take_snapshot()
        except FileFormatError as error:
            note(str(error))
        else:
            note(f"snapshot: {path or 'no messages'}")

    def _end(self) -> None:
        self._is_over = True
