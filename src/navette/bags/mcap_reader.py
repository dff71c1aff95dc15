"""Read ``.mcap`` files, with or without summary and chunks, of ROS 2 and ROS 1."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from navette.bags.bag import BagTopic
from navette.bags.chunked_reader import ChunkedReader, Convert
from navette.bags.chunks import Chunk, Entry, FileIndex
from navette.bags.definitions import idl_to_msg, ros2_name
from navette.bags.mcap_index import read_index, read_message_indexes, scan
from navette.bags.mcap_records import RecordFile, message_entries, read_chunk
from navette.bags.qos import parse_qos
from navette.bags.ros1_messages import ros1_type
from navette.errors import DecodeError, FileFormatError, NavetteError


class McapReader(ChunkedReader):
    """An open ``.mcap`` file.

    Raises:
        FileFormatError: the file does not exist or is not MCAP.
    """

    storage = "mcap"
    version = "0"

    _file: RecordFile

    def __init__(self, path: Path) -> None:
        super().__init__(RecordFile(path))

    def _read_index(self) -> FileIndex:
        index = read_index(self._file)
        for number, channel in index.channels.items():
            schema = index.schemas.get(channel.schema_id)
            try:
                topic, convert = _topic(channel, schema, index.problems)
            except NavetteError as error:
                index.problems.append(f"topic {channel.topic}: {error}")
                continue
            self._add_channel(number, topic, convert)
        return index

    def scanned(self) -> FileIndex:
        return scan(self._file)

    def _read_chunk(self, chunk: Chunk) -> bytes:
        return read_chunk(self._file, chunk)

    def _entries(self, chunk: Chunk, data: bytes) -> list[Entry]:
        return message_entries(self.path, chunk, data)

    def index_of(self, chunk: Chunk) -> Mapping[int, Sequence[int]] | None:
        if chunk.bare:
            return None
        after = chunk.position + chunk.length
        try:
            return read_message_indexes(self._file, after) or None
        except DecodeError as error:
            raise self._file.error(after, str(error)) from error


def _topic(
    channel: Any, schema: Any, problems: list[str]
) -> tuple[BagTopic, Convert | None]:
    """Convert a channel to a topic, with the conversion of its messages to CDR."""
    qos = parse_qos(channel.metadata.get("offered_qos_profiles", ""))
    name = schema.name if schema is not None else ""
    text = schema.data.decode("utf-8", "replace") if schema is not None else ""
    kind = schema.encoding if schema is not None else ""
    encoding = channel.message_encoding
    if encoding == "ros1" and kind == "ros1msg":
        ros1 = ros1_type(name, text)
        topic = BagTopic(channel.topic, ros1.type_name, ros1.definition, qos=qos)
        return topic, ros1.to_cdr
    if kind == "ros2idl":
        try:
            text = idl_to_msg(ros2_name(name), text)
        except FileFormatError as error:
            problems.append(f"topic {channel.topic}: {error}")
            text = ""
    elif kind != "ros2msg":
        text = ""
    return BagTopic(
        channel.topic,
        ros2_name(name) if encoding == "cdr" else name,
        text,
        channel.metadata.get("topic_type_hash", ""),
        qos,
        encoding,
    ), None
