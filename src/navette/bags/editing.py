"""Create a recording from others: convert, filter, merge, cut, recover."""

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from navette.bags.bag import BagMessage, BagReader, BagTopic, OnDamage
from navette.bags.folder_reader import FolderReader, Metadata
from navette.bags.message_types import Decoder
from navette.bags.opening import open_bag
from navette.bags.topic_writer import TopicWriter
from navette.bags.writing import completed
from navette.errors import FileFormatError, InvalidValueError
from navette.msgs.expressions import Expression, ExpressionError

Progress = Callable[[BagMessage], None]


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

    def takes(self, topic: BagTopic) -> bool:
        if self.exclude and _search(self.exclude, topic.name):
            return False
        if not (self.topics or self.types or self.regex):
            return True
        return (
            topic.name in self.topics
            or topic.type_name in self.types
            or topic.type_name.replace("/msg/", "/") in self.types
            or (bool(self.regex) and _search(self.regex, topic.name))
        )


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

    def __call__(self, message: BagMessage) -> bool:
        try:
            return bool(self._expression.value(_Names(self, message)))
        except ExpressionError as error:
            where = f"{message.topic.name} at {message.stamp_ns} ns"
            raise InvalidValueError(f"{where}: {error}") from None

    def decode(self, message: BagMessage) -> Any:
        decoder = self._decoders.get(message.topic)
        if decoder is None:
            decoder = self._decoders[message.topic] = Decoder(message.topic)
        return decoder(message.data)


class _Names(dict[str, Any]):
    """Variables of the expression; ``m`` is decoded only when it is read."""

    def __init__(self, condition: _Condition, message: BagMessage) -> None:
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
    """Write the selected messages; return their number.

    The writer is closed, or abandoned after an error.

    Raises:
        FileFormatError: a part cannot be read (without ``on_damage``) or written.
        InvalidValueError: a pattern or an expression is wrong.
    """
    selected = selected or MessageFilter()
    try:
        for message in _chosen(reader, selected, on_message, on_damage):
            writer.write(message)
    except BaseException:
        writer.abandon()
        raise
    writer.close()
    return writer.message_count


def _chosen(
    reader: BagReader,
    selected: MessageFilter,
    on_message: Progress | None,
    on_damage: OnDamage | None,
) -> Iterator[BagMessage]:
    expression = _Condition(selected.expression) if selected.expression else None
    taken = {t: completed(t) for t in reader.topics if selected.takes(t)}
    for message in reader.messages(
        {topic.name for topic in taken},
        start_ns=selected.start_ns,
        end_ns=selected.end_ns,
        on_damage=on_damage,
    ):
        if on_message is not None:
            on_message(message)
        topic = taken.get(message.topic)
        if topic is not None and (expression is None or expression(message)):
            yield message._replace(topic=topic)
