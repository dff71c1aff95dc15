"""Write ``.db3`` and ``.bag`` files through ``rosbags``."""

import sqlite3
import struct
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from navette.bags.bag import BagMessage, BagTopic
from navette.bags.topic_writer import TopicWriter
from navette.errors import FileFormatError, InvalidValueError
from navette.msgs.definition_sections import read_definition

_FIRST_TOO_LATE_NS = (1 << 32) * 1_000_000_000
_HEADER = "std_msgs/msg/Header"


def store_of(topic: BagTopic, path: Path) -> Any:
    """Return a ``rosbags`` type store with a topic's type.

    Raises:
        FileFormatError: missing or invalid definition.
    """
    from rosbags.typesys import Stores, TypesysError, get_types_from_msg, get_typestore

    if not topic.definition:
        raise FileFormatError(
            path,
            f"{topic.name}: {topic.type_name} has no definition, which this format "
            "requires",
        )
    read_definition(topic.type_name, topic.definition)  # refuses hostile definitions
    store = get_typestore(Stores.EMPTY)
    try:
        store.register(get_types_from_msg(topic.definition, topic.type_name))
    except (TypesysError, KeyError, ValueError, RecursionError) as error:
        raise FileFormatError(
            path, f"{topic.name}: definition of {topic.type_name}: {error}"
        ) from error
    return store


class Db3Writer(TopicWriter):
    """Writes rosbag2's SQLite, schema 4.

    Args:
        path: a name with the suffix ``.db3`` is a single file, others are a folder with
            ``metadata.yaml``.
        compression: ``none``, or ``zstd`` of the whole file (folders only).
    """

    def __init__(self, path: Path, *, compression: str = "none") -> None:
        from rosbags.rosbag2 import StoragePlugin, Writer
        from rosbags.rosbag2.enums import CompressionFormat, CompressionMode

        super().__init__(path)
        is_file = path.suffix == ".db3"
        if compression not in ("none", "zstd") or (is_file and compression != "none"):
            raise InvalidValueError(
                f"compression {compression!r} of SQLite; known: none, and zstd in a "
                "folder (a name without .db3)"
            )
        try:
            # Written beside the target, so that the target is complete or absent.
            self._temporary = TemporaryDirectory(prefix=".navette-", dir=path.parent)
            folder = Path(self._temporary.name) / path.stem
            self._writer = Writer(
                folder, version=8, storage_plugin=StoragePlugin.SQLITE3
            )
            if compression == "zstd":
                self._writer.set_compression(
                    CompressionMode.FILE, CompressionFormat.ZSTD
                )
            self._writer.open()
        except OSError as error:
            raise self._error(error) from error
        self._made = folder / f"{folder.name}.db3" if is_file else folder

    def write(self, message: BagMessage) -> None:
        channel = self.channel_of(message.topic)
        try:
            self._writer.write(channel, message.stamp_ns, message.data)
        except sqlite3.Error as error:
            raise self._error(error) from error
        self.message_count += 1

    def _add(self, topic: BagTopic) -> Any:
        from rosbags.rosbag2 import WriterError

        store = store_of(topic, self.path)
        try:
            return self._writer.add_connection(
                topic.name,
                topic.type_name,
                msgdef=topic.definition,
                rihs01=topic.type_hash or store.hash_rihs01(topic.type_name),
                serialization_format=topic.encoding,
                offered_qos_profiles=[_qos(each) for each in topic.qos],
            )
        except WriterError as error:
            raise FileFormatError(self.path, f"{topic.name}: {error}") from error

    def close(self) -> None:
        try:
            self._writer.close()
            self._made.replace(self.path)
        except (sqlite3.Error, OSError) as error:
            raise self._error(error) from error
        finally:
            self._temporary.cleanup()

    def abandon(self) -> None:
        with suppress(sqlite3.Error, OSError):
            self._writer.abort()
        self._temporary.cleanup()


def _qos(offer: Any) -> Any:
    from rosbags.interfaces import (
        Qos,
        QosDurability,
        QosHistory,
        QosLiveliness,
        QosReliability,
        QosTime,
    )

    times = [divmod(ns, 1_000_000_000) for ns in (offer.deadline_ns, offer.lifespan_ns)]
    return Qos(
        QosHistory[offer.history.upper()],
        offer.depth,
        QosReliability[offer.reliability.upper()],
        QosDurability[offer.durability.upper()],
        QosTime(*times[0]),
        QosTime(*times[1]),
        QosLiveliness[offer.liveliness.upper()],
        QosTime(*divmod(offer.lease_ns, 1_000_000_000)),
        avoid_ros_namespace_conventions=False,
    )


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
        self._part = path.with_name(f".{path.name}.part")
        try:
            self._part.unlink(missing_ok=True)
            self._writer = Writer(self._part)
            if compression != "none":
                self._writer.set_compression(
                    Writer.CompressionFormat[compression.upper()]
                )
            self._writer.open()
        except OSError as error:
            raise self._error(error) from error

    def write(self, message: BagMessage) -> None:
        from rosbags.serde import SerdeError

        channel, convert = self.channel_of(message.topic)
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
        if topic.encoding != "cdr":
            raise FileFormatError(
                self.path,
                f"{topic.name}: {topic.encoding} messages are not ROS messages",
            )
        source = store_of(topic, self.path)
        channel = self._writer.add_connection(
            topic.name,
            topic.type_name,
            typestore=_ros1_store(source),
            callerid="/navette",
            latching=int(topic.latched),
        )
        return channel, source.cdr_to_ros1

    def close(self) -> None:
        try:
            self._writer.close()
            self._part.replace(self.path)
        except OSError as error:
            raise self._error(error) from error

    def abandon(self) -> None:
        with suppress(OSError):
            self._writer.close()
        self._part.unlink(missing_ok=True)


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
