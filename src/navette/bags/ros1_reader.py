"""Read ROS 1 ``.bag`` files, indexed or not, as ROS 2 messages."""

import struct
from collections.abc import Mapping, Sequence
from pathlib import Path

from navette.bags.bag import BagTopic, RecordedChannel
from navette.bags.chunked_reader import ChunkedReader
from navette.bags.chunks import Chunk, Entry, FileIndex
from navette.bags.qos import OfferedQos
from navette.bags.ros1_index import Connection, read_index, scan
from navette.bags.ros1_messages import ros1_type
from navette.bags.ros1_records import (
    BagFile,
    Op,
    message_entries,
    read_chunk,
    uint32,
)
from navette.errors import DecodeError, NavetteError

_LATCHED = (OfferedQos(depth=1, durability="transient_local"),)


class Ros1Reader(ChunkedReader):
    """An open ``.bag`` file.

    Raises:
        FileFormatError: the file does not exist or is not a ROS 1 bag, version 2.0.
    """

    storage = "rosbag1"
    version = "2.0"

    _file: BagFile

    def __init__(self, path: Path) -> None:
        super().__init__(BagFile(path))

    def _read_index(self) -> FileIndex:
        index = read_index(self._file)
        for number, connection in sorted(index.connections.items()):
            qos = _LATCHED if connection.latching else ()
            try:
                ros1 = ros1_type(connection.type_name, connection.definition)
            except NavetteError as error:
                name = connection.topic
                index.remarks.append(f"topic {name}: not converted to ROS 2: {error}")
                self._add_channel(number, _unconverted(connection, qos))
                continue
            topic = BagTopic(connection.topic, ros1.type_name, ros1.definition, qos=qos)
            self._add_channel(number, topic, ros1.to_cdr)
        return index

    def scanned(self) -> FileIndex:
        return scan(self._file)

    def read_chunk(self, chunk: Chunk) -> bytes:
        return read_chunk(self._file, chunk)

    def parse_chunk(self, chunk: Chunk, data: bytes) -> list[Entry]:
        return message_entries(self.path, chunk, data)

    def index_of(self, chunk: Chunk) -> Mapping[int, Sequence[int]] | None:
        found: dict[int, list[int]] = {}
        if chunk.bare:
            return None
        position = chunk.position + chunk.length
        try:
            while position < self.size:
                record = self._file.record(position)
                if record.op != Op.INDEX:
                    break
                stamps = [
                    seconds * 1_000_000_000 + rest
                    for seconds, rest, _ in struct.iter_unpack(
                        "<III", self._file.data(record)
                    )
                ]
                found.setdefault(uint32(record.fields, b"conn"), []).extend(stamps)
                position = record.end
        except (DecodeError, struct.error) as error:
            raise self._file.error(position, str(error)) from error
        return found or None


def _unconverted(connection: Connection, qos: tuple[OfferedQos, ...]) -> BagTopic:
    """Return the topic of a connection whose definition cannot be read."""
    text = connection.definition.encode()
    name = connection.type_name
    recorded = RecordedChannel("ros1", name, "ros1msg", text)
    return BagTopic(connection.topic, name, qos=qos, encoding="ros1", channel=recorded)
