"""Read ``.mcap`` files, with or without summary and chunks, of ROS 2 and ROS 1."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from mcap.records import Channel, Schema

from navette.bags.bag import BagAttachment, BagTopic, MetadataRecord, RecordedChannel
from navette.bags.chunked_reader import ChunkedReader
from navette.bags.chunks import Chunk, Entry
from navette.bags.definitions import msg_text, ros2_name
from navette.bags.mcap_extras import (
    ExtraPositions,
    read_attachment,
    read_metadata_record,
    scan_for_extras,
)
from navette.bags.mcap_index import McapIndex, read_index, read_message_indexes, scan
from navette.bags.mcap_records import RecordFile, message_entries, read_chunk
from navette.bags.qos import OfferedQos, parse_qos
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
    index: McapIndex

    def __init__(self, path: Path) -> None:
        super().__init__(RecordFile(path))
        self.profile = self.index.profile

    def _read_index(self) -> McapIndex:
        index = read_index(self._file)
        for number, channel in index.channels.items():
            schema = index.schemas.get(channel.schema_id)
            self._add_channel(number, _topic(channel, schema, index.remarks))
        return index

    def scanned(self) -> McapIndex:
        return scan(self._file)

    def attachments(self) -> Sequence[BagAttachment]:
        positions = self._extras().attachments
        return [read_attachment(self._file, position) for position in positions]

    def metadata_records(self) -> Sequence[MetadataRecord]:
        positions = self._extras().metadata
        return [read_metadata_record(self._file, position) for position in positions]

    def _extras(self) -> ExtraPositions:
        if not self.index.extras.is_complete:  # a summary without their indexes
            self.index.extras = scan_for_extras(self._file)
            found = self.index.extras
            found.stated = len(found.attachments), len(found.metadata)
        return self.index.extras

    def read_chunk(self, chunk: Chunk) -> bytes:
        return read_chunk(self._file, chunk)

    def parse_chunk(self, chunk: Chunk, data: bytes) -> list[Entry]:
        return message_entries(self.path, chunk, data)

    def index_of(self, chunk: Chunk) -> Mapping[int, Sequence[int]] | None:
        if chunk.bare:
            return None
        after = chunk.position + chunk.length
        try:
            return read_message_indexes(self._file, after) or None
        except DecodeError as error:
            raise self._file.error(after, str(error)) from error


def _topic(channel: Channel, schema: Schema | None, remarks: list[str]) -> BagTopic:
    """Convert a channel to a topic; what cannot be read becomes a remark."""
    recorded = RecordedChannel(
        channel.message_encoding,
        "" if schema is None else schema.name,
        "" if schema is None else schema.encoding,
        None if schema is None else schema.data,
        tuple(channel.metadata.items()),
    )
    qos = parse_qos(channel.metadata.get("offered_qos_profiles", ""))
    if (recorded.encoding, recorded.schema_encoding) == ("ros1", "ros1msg"):
        try:
            return _ros1_topic(channel.topic, recorded, qos)
        except NavetteError as error:
            remarks.append(f"topic {channel.topic}: not converted to ROS 2: {error}")
    text = ""
    try:
        text = msg_text(recorded)
    except FileFormatError as error:
        remarks.append(f"topic {channel.topic}: {error}")
    name = recorded.schema_name
    return BagTopic(
        channel.topic,
        ros2_name(name) if recorded.encoding == "cdr" else name,
        text,
        channel.metadata.get("topic_type_hash", ""),
        qos,
        recorded.encoding,
        recorded,
    )


def _ros1_topic(
    name: str, recorded: RecordedChannel, qos: tuple[OfferedQos, ...]
) -> BagTopic:
    text = (recorded.schema or b"").decode("utf-8", "replace")
    ros1 = ros1_type(recorded.schema_name, text)
    channel = replace(recorded, to_cdr=ros1.to_cdr)
    return BagTopic(name, ros1.type_name, ros1.definition, qos=qos, channel=channel)
