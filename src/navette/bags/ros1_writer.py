"""Write ``.bag`` files through ``rosbags``."""

import struct
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from navette.bags.bag import BagMessage, BagTopic, RecordedMessage
from navette.bags.message_types import is_empty_type
from navette.bags.topic_writer import (
    TopicWriter,
    UnsupportedTopicError,
    other_metadata,
)
from navette.errors import FileFormatError, InvalidValueError, NavetteError
from navette.msgs.definition_sections import read_definition
from navette.msgs.interface import MessageSpec

_FIRST_TOO_LATE_NS = (1 << 32) * 1_000_000_000
_HEADER = "std_msgs/msg/Header"


def store_of(topic: BagTopic, path: Path) -> Any:
    """Return a ``rosbags`` type store with a topic's type.

    Raises:
        UnsupportedTopicError: missing or invalid definition, or a part of a service.
    """
    from rosbags.typesys import Stores, TypesysError, get_types_from_msg, get_typestore

    if not topic.definition and not is_empty_type(topic):
        raise UnsupportedTopicError(
            path, f"{topic.type_name} has no definition, which this format requires"
        )
    if "/msg/" not in topic.type_name:
        raise UnsupportedTopicError(path, f"ROS 1 has no {topic.type_name}")
    try:
        read_definition(topic.type_name, topic.definition)  # refuses hostile ones
        store = get_typestore(Stores.EMPTY)
        store.register(get_types_from_msg(topic.definition, topic.type_name))
    except (
        *(NavetteError, TypesysError, KeyError),
        *(ValueError, RecursionError),
    ) as error:
        raise UnsupportedTopicError(
            path, f"definition of {topic.type_name}: {error}"
        ) from error
    return store


class Ros1Writer(TopicWriter):
    """Writes a ROS 1 bag, version 2.0, with ROS 1 type names.

    Args:
        compression: ``none``, ``lz4`` or ``bz2``.
    """

    def __init__(self, path: Path, *, compression: str = "none") -> None:
        from rosbags.rosbag1 import Writer

        super().__init__(path)
        if compression not in ("none", "lz4", "bz2"):
            raise InvalidValueError(
                f"compression {compression!r} of .bag; known: none, lz4, bz2"
            )
        self._connections: dict[tuple[Any, ...], tuple[Any, Callable[..., Any]]] = {}
        try:
            # Written beside the target, so that the target is complete or absent.
            self._temporary = TemporaryDirectory(prefix=".navette-", dir=path.parent)
            self._part = Path(self._temporary.name) / path.name
            self._writer = Writer(self._part)
            if compression != "none":
                self._writer.set_compression(
                    Writer.CompressionFormat[compression.upper()]
                )
            self._writer.open()
        except OSError as error:
            raise self._error(error) from error

    def write(self, message: BagMessage | RecordedMessage) -> None:
        from rosbags.serde import SerdeError

        channel, convert = self.channel_of(message.topic)
        self._note_losses(message)
        try:
            if not 0 <= message.stamp_ns < _FIRST_TOO_LATE_NS:
                raise ValueError("ROS 1 stamps range from 1970 to 2106")
            data = convert(message.data, message.topic.type_name)
            self._writer.write(channel, message.stamp_ns, data)
        except OSError as error:
            raise self._error(error) from error
        except (SerdeError, struct.error, ValueError, IndexError, TypeError) as error:
            raise FileFormatError(
                self.path,
                f"{message.topic.name} at {message.stamp_ns} ns: message or stamp "
                f"cannot be represented in ROS 1: {error}",
            ) from error
        self.message_count += 1

    def _add(self, topic: BagTopic) -> tuple[Any, Callable[..., Any]]:
        from rosbags.rosbag1 import WriterError

        if topic.encoding != "cdr":
            raise UnsupportedTopicError(
                self.path, f"{topic.encoding} messages are not ROS messages"
            )
        if other := other_metadata(topic):
            self.losses.add("channel metadata entries", topic.name, len(other))
        key = topic.name, topic.type_name, topic.definition, topic.latched
        if key not in self._connections:
            source = store_of(topic, self.path)
            try:
                channel = self._writer.add_connection(
                    topic.name,
                    topic.type_name,
                    typestore=_ros1_store(source),
                    callerid="/navette",
                    latching=int(topic.latched),
                )
            except (WriterError, ValueError, KeyError) as error:
                raise UnsupportedTopicError(self.path, str(error)) from error
            top = read_definition(topic.type_name, topic.definition)[0]
            is_fieldless = isinstance(top, MessageSpec) and not top.fields
            convert = _nothing if is_fieldless else source.cdr_to_ros1
            self._connections[key] = channel, convert
        return self._connections[key]

    def close(self) -> None:
        try:
            self._writer.close()
            self._part.replace(self.path)
        except OSError as error:
            raise self._error(error) from error
        finally:
            self._temporary.cleanup()

    def abandon(self) -> None:
        with suppress(OSError):
            self._writer.close()
        self._temporary.cleanup()


def _nothing(data: bytes, type_name: str) -> bytes:
    """Return a message without fields."""
    return b""


def _ros1_store(source: Any) -> Any:
    """Convert types to ROS 1 definitions.

    ROS 1 identifies types by a checksum of their text: if it has the type with the same
    serialization, its own text must be used (field name ``D``, not ``d``).
    """
    from rosbags.typesys import Stores, get_typestore

    noetic = get_typestore(Stores.ROS1_NOETIC)
    fields = dict(source.fielddefs)
    for name in fields:
        if name == _HEADER or _is_alike(source.fielddefs, noetic.fielddefs, name):
            fields[name] = noetic.fielddefs[name]
    store = get_typestore(Stores.EMPTY)
    store.register(fields)
    return store


def _is_alike(ours: Any, theirs: Any, name: str) -> bool:
    """Whether both define a type identically, except for field names."""
    if name == _HEADER:
        return True
    if name not in ours or name not in theirs:
        return False
    mine = [kind for _, kind in ours[name][1]]
    other = [kind for _, kind in theirs[name][1]]
    return mine == other and all(
        _is_alike(ours, theirs, each) for kind in mine for each in _names_in(kind)
    )


def _names_in(kind: Any) -> list[str]:
    """Message types that a field's type refers to, in ``rosbags``' description."""
    from rosbags.interfaces import Nodetype

    if kind[0] == Nodetype.NAME:
        return [kind[1]]
    if kind[0] in (Nodetype.ARRAY, Nodetype.SEQUENCE):
        return _names_in(kind[1][0])
    return []
