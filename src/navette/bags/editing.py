"""Create a recording from others: convert, filter, merge, cut, recover."""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from navette.bags.bag import BagReader, BagTopic, Damage, OnDamage, RecordedMessage
from navette.bags.folder_reader import FolderReader, Metadata
from navette.bags.message_types import Decoder
from navette.bags.opening import open_bag
from navette.bags.topic_writer import TopicWriter, UnsupportedTopicError
from navette.bags.writing import completed
from navette.errors import (
    FileFormatError,
    InvalidValueError,
    UnknownNameError,
    join_names,
)
from navette.msgs.expressions import Expression, ExpressionError

Progress = Callable[[int], None]


@dataclass(frozen=True)
class MessageFilter:
    """Selection of messages for the new recording; all by default.

    A topic is selected if it is named, matches the pattern or has one of the types
    (without any of the three: every topic), unless it is excluded.
    """

    topics: tuple[str, ...] = ()
    types: tuple[str, ...] = ()
    regex: str = ""
    exclude: str = ""
    start_ns: int | None = None
    end_ns: int | None = None
    """The last stamp, included."""
    expression: str = ""
    """Python expression over ``topic`` (name), ``t`` (s), ``m`` (message)."""

    def choose(self, topics: Sequence[BagTopic]) -> list[BagTopic]:
        """Return the selected topics of a recording.

        Raises:
            UnknownNameError: a named topic or type was not recorded.
            InvalidValueError: no topic is selected.
        """
        names = sorted({each.name for each in topics})
        for name in self.topics:
            if name not in names:
                raise UnknownNameError.of("topic", name, names)
        types = sorted({each.type_name for each in topics})
        for name in self.types:
            if name not in {*types, *map(_short, types)}:
                raise UnknownNameError.of("type", name, types)
        chosen = [each for each in topics if self.takes(each)]
        if topics and not chosen:
            raise InvalidValueError(
                f"no topic is selected; recorded topics: {join_names(names, most=100)}"
            )
        return chosen

    def takes(self, topic: BagTopic) -> bool:
        if self.exclude and _search(self.exclude, topic.name):
            return False
        if not (self.topics or self.types or self.regex):
            return True
        return (
            topic.name in self.topics
            or topic.type_name in self.types
            or _short(topic.type_name) in self.types
            or (bool(self.regex) and _search(self.regex, topic.name))
        )


def _short(type_name: str) -> str:
    """Return the name of a type as in ROS 1: ``std_msgs/String``."""
    return type_name.replace("/msg/", "/")


def _search(pattern: str, text: str) -> bool:
    try:
        return re.search(pattern, text) is not None
    except re.error as error:
        raise InvalidValueError(
            f"{pattern!r} is not a regular expression: {error}"
        ) from None


class _Condition:
    """Condition on the messages of a bag, as in ``rosbag filter``."""

    def __init__(self, text: str) -> None:
        self._expression = Expression(text, names=("topic", "t", "m"))
        self._decoders: dict[BagTopic, Decoder] = {}

    def __call__(self, message: RecordedMessage) -> bool:
        try:
            return bool(self._expression.value(_Names(self, message)))
        except ExpressionError as error:
            where = f"{message.topic.name} at {message.stamp_ns} ns"
            raise InvalidValueError(f"{where}: {error}") from None

    def decode(self, message: RecordedMessage) -> Any:
        decoder = self._decoders.get(message.topic)
        if decoder is None:
            decoder = self._decoders[message.topic] = Decoder(message.topic)
        return decoder(message.data)


class _Names(dict[str, Any]):
    """Variables of the expression; ``m`` is decoded only when it is read."""

    def __init__(self, condition: _Condition, message: RecordedMessage) -> None:
        super().__init__(topic=message.topic.name, t=message.stamp_ns / 1e9)
        self._condition = condition
        self._message = message

    def __missing__(self, name: str) -> Any:
        if name != "m":
            raise KeyError(name)
        return self._condition.decode(self._message)


def join(paths: Sequence[Path]) -> BagReader:
    """Merge several recordings in time order.

    Raises:
        FileFormatError: one of them cannot be read.
    """
    if len(paths) == 1:
        return open_bag(paths[0])
    readers: list[BagReader] = []
    try:
        for path in paths:
            readers.append(open_bag(path))
    except FileFormatError:
        for reader in readers:
            reader.close()
        raise
    return FolderReader(paths[0], readers, Metadata())


def copy(
    reader: BagReader,
    writer: TopicWriter,
    selected: MessageFilter | None = None,
    *,
    on_message: Progress | None = None,
    on_damage: OnDamage | None = None,
) -> int:
    """Write the selected messages, all attachments and metadata; return their number.

    Messages keep their encoding, publish times and sequence numbers, and topics their
    schemas and metadata, as far as the format can hold them; ``writer.losses`` lists
    the rest. The writer is closed, or abandoned after an error.

    Raises:
        FileFormatError: a part cannot be read (without ``on_damage``) or written.
        InvalidValueError: a pattern or an expression is wrong, or no message is
            selected.
        UnknownNameError: a selected topic or type was not recorded.
    """
    selected = selected or MessageFilter()
    try:
        _copy_extras(reader, writer, on_damage)
        for message in _chosen(reader, writer, selected, on_message, on_damage):
            writer.write(message)
        if selected != MessageFilter() and reader.end_ns > 0:
            _refuse_nothing(writer)
    except BaseException:
        writer.abandon()
        raise
    writer.close()
    return writer.message_count


def _refuse_nothing(writer: TopicWriter) -> None:
    """Refuse a copy without messages of a recording that has some."""
    if writer.message_count == 0 and not writer.losses.lines:
        raise InvalidValueError(f"no message is selected; {writer.path} is not written")


def _copy_extras(
    reader: BagReader, writer: TopicWriter, on_damage: OnDamage | None
) -> None:
    def attempt(work: Callable[[], None]) -> None:
        try:
            work()
        except FileFormatError as error:
            if on_damage is None or error.path == writer.path:
                raise
            on_damage(Damage(error.path, 0, error.reason))

    def copy_attachments() -> None:
        for attachment in reader.attachments():
            attempt(partial(writer.add_attachment, attachment))

    def copy_metadata() -> None:
        for record in reader.metadata_records():
            attempt(partial(writer.add_metadata, record))

    attempt(copy_attachments)
    attempt(copy_metadata)


def _chosen(
    reader: BagReader,
    writer: TopicWriter,
    selected: MessageFilter,
    on_message: Progress | None,
    on_damage: OnDamage | None,
) -> Iterator[RecordedMessage]:
    expression = _Condition(selected.expression) if selected.expression else None
    topics = selected.choose(reader.topics)
    if writer.keeps_encoding:
        topics = [topic.as_recorded for topic in topics]
    taken = {topic: completed(topic) for topic in topics}
    refused = _add_topics(writer, taken)
    for message in reader.recorded_messages(
        {topic.name for topic in taken},
        start_ns=selected.start_ns,
        end_ns=selected.end_ns,
        on_damage=on_damage,
        as_cdr=not writer.keeps_encoding,
    ):
        if on_message is not None:
            on_message(message.stamp_ns)
        topic = taken.get(message.topic)
        if topic is None or (expression is not None and not expression(message)):
            continue
        if topic in refused:
            writer.losses.add(refused[topic], topic.name)
            continue
        yield message._replace(topic=topic)


def _add_topics(
    writer: TopicWriter, taken: Mapping[BagTopic, BagTopic]
) -> dict[BagTopic, str]:
    """Add all topics, also those without messages; return those refused, as losses."""
    refused: dict[BagTopic, str] = {}
    for topic in taken.values():
        try:
            writer.add_topic(topic)
        except UnsupportedTopicError as error:
            refused[topic] = f"messages: {error.reason}"
            writer.losses.add(refused[topic], topic.name, 0)
    return refused
