"""Write bag files: MCAP with the ``ros2`` profile, as rosbag2 does.

Source: the MCAP specification and its ``ros2`` profile (foxglove/mcap). The same
messages produce the same bytes: the file contains no wall time, random number or
library version; chunks end by size and by :meth:`flush`, which the caller must tie to
message time.

Compressed chunks are four to ten times smaller than single records, and readers seek by
chunk. Messages that are not in a finished chunk are lost with the process, so flush
often.
"""

import os
from contextlib import suppress
from io import BufferedWriter, BytesIO, FileIO
from pathlib import Path
from typing import IO, cast

from navette.bags.bag import (
    BagAttachment,
    BagTopic,
    MetadataRecord,
    RecordedChannel,
    RecordedMessage,
)
from navette.bags.mcap_file import COMPRESSIONS, McapFile
from navette.bags.qos import qos_text
from navette.bags.recording_file import RecordingFile
from navette.bags.reserve import Reserve
from navette.errors import InvalidValueError

_CHUNK_BYTES = 256 * 1024
# Larger than any chunk: a chunk and its index are written in one call.
_BUFFER_BYTES = 4 * 2**20
_LIBRARY = "navette"
_MOST_SACRIFICED = 4
"""Chunks dropped for the index if the disk is full and the reserve too small."""


class BagWriter:
    """Writes one new ``.mcap`` file.

    Args:
        compression: of the chunks: ``zstd``, ``lz4`` or ``none``.
        overwrite: replace an existing bag that no other process records.
        profile: of the header.

    Raises:
        InvalidValueError: another compression.
        FileFormatError: the file cannot be created, exists, or is being recorded; names
            path and reason.

    All methods except :meth:`abandon` raise ``OSError`` if the disk is full or gone, or
    if another program has replaced, removed or truncated the file.
    """

    def __init__(
        self,
        path: Path,
        *,
        compression: str = "zstd",
        overwrite: bool = False,
        profile: str = "ros2",
    ) -> None:
        if compression not in COMPRESSIONS:
            raise InvalidValueError(
                f"compression {compression!r} of .mcap; "
                f"known: {', '.join(COMPRESSIONS)}"
            )
        self.path = path
        start = BytesIO()
        self._mcap = McapFile(
            start, profile=profile, library=_LIBRARY, compression=compression
        )
        self._file = RecordingFile(path, start.getvalue(), overwrite=overwrite)
        self._stream = BufferedWriter(self._file.raw, _BUFFER_BYTES)
        self._mcap.stream = self._stream
        self._flushed = self._mcap.written
        self._schemas: dict[tuple[str, str, bytes], int] = {}
        self._reserve = Reserve(path.parent)

    def add_channel(
        self,
        topic: str,
        type_name: str,
        definition: str,
        *,
        type_hash: str = "",
        qos: str = "",
        encoding: str = "cdr",
    ) -> int:
        """Announce a topic; gives the channel's number for :meth:`write`.

        Args:
            definition: ros2msg text of the type and all types it holds.
            type_hash: ``RIHS01_…``.
            qos: what its publishers offer, see :func:`navette.bags.qos_text`.
            encoding: of the messages, where they are not ROS 2's.
        """
        schema = self._schema(type_name, "ros2msg", definition.encode())
        metadata = {"offered_qos_profiles": qos, "topic_type_hash": type_hash}
        return self._mcap.add_channel(topic, encoding, schema, metadata)

    def add_topic(self, topic: BagTopic) -> int:
        """Add a channel for a topic of a recording, as recorded if its encoding is."""
        recorded = topic.channel
        if recorded is not None and recorded.encoding == topic.encoding:
            return self._add_recorded(topic, recorded)
        return self.add_channel(
            topic.name,
            topic.type_name,
            topic.definition,
            type_hash=topic.type_hash,
            qos=qos_text(topic.qos),
            encoding=topic.encoding,
        )

    def _add_recorded(self, topic: BagTopic, recorded: RecordedChannel) -> int:
        schema = 0
        if recorded.schema is not None:
            schema = self._schema(
                recorded.schema_name, recorded.schema_encoding, recorded.schema
            )
        metadata = dict(recorded.metadata)
        known = {
            "offered_qos_profiles": qos_text(topic.qos),
            "topic_type_hash": topic.type_hash,
        }
        for key, value in known.items():  # from a folder's metadata.yaml
            if value and not metadata.get(key):
                metadata[key] = value
        return self._mcap.add_channel(topic.name, recorded.encoding, schema, metadata)

    def _schema(self, name: str, encoding: str, data: bytes) -> int:
        key = name, encoding, data
        if key not in self._schemas:
            self._schemas[key] = self._mcap.add_schema(*key)
        return self._schemas[key]

    def write(self, channel: int, stamp_ns: int, payload: bytes) -> None:
        """Append a message: CDR with its 4-byte header, and the time of reception."""
        self._mcap.add_message(channel, stamp_ns, payload)
        if self._mcap.chunk_size > _CHUNK_BYTES:
            self.flush()

    def write_recorded(self, channel: int, message: RecordedMessage) -> None:
        """Append a message of another recording, with everything that was recorded."""
        self._mcap.add_message(channel, message.stamp_ns, message.data)
        self._mcap.set_recorded(message.publish_ns, message.sequence)
        if self._mcap.chunk_size > _CHUNK_BYTES:
            self.flush()

    def add_attachment(self, attachment: BagAttachment) -> None:
        """Copy a file of another recording.

        Raises:
            FileFormatError: it is damaged; nothing is written.
        """
        self._mcap.add_attachment(attachment)

    def add_metadata(self, record: MetadataRecord) -> None:
        """Add named texts."""
        self._mcap.add_metadata(record.name, record.values)

    @property
    def message_count(self) -> int:
        """Messages written so far."""
        return self._mcap.message_count

    @property
    def size(self) -> int:
        """Bytes of finished chunks and of the current one."""
        return self._mcap.size

    def flush(self) -> None:
        """Finish the chunk and write it, so that it survives this process."""
        self._file.check(self._flushed)
        self._mcap.end_chunk()
        self._stream.flush()
        self._flushed = self._mcap.written
        self._reserve.grow(self._mcap.index_size)

    def close(self) -> None:
        """Write the index and close; a second call has no effect."""
        if not self._stream.closed:
            self._file.check(self._flushed)
            self._reserve.release()
            self._mcap.finish()
            self._stream.close()

    def abandon(self) -> None:
        """Close after an ``OSError``; flushed messages stay readable.

        Space for the index is reserved from the start, also for a full disk.
        """
        if self._stream.closed:
            self._reserve.release()
            return
        # The file itself, not its name, which may refer to another file by now.
        own = os.dup(self._file.raw.fileno())
        with suppress(OSError):  # the same error again
            self._stream.close()
        self._reserve.release()
        with suppress(OSError), FileIO(own, "r+") as file:  # readable without an index
            self._finish_what_is_there(file)

    def _finish_what_is_there(self, file: FileIO) -> None:
        size = os.fstat(file.fileno()).st_size
        for _ in range(_MOST_SACRIFICED):
            size = self._mcap.keep(size)
            file.truncate(size)
            file.seek(size)
            try:
                self._mcap.finish(cast(IO[bytes], _Whole(file)))
            except OSError:
                size -= 1  # drop the chunk that ends there next
            else:
                return
        file.truncate(self._mcap.keep(size))


class _Whole:
    """Writes all bytes or raises: a raw file may write only a part."""

    def __init__(self, file: FileIO) -> None:
        self._file = file

    def write(self, data: bytes) -> int:
        rest = memoryview(data)
        while rest:
            rest = rest[self._file.write(rest) :]
        return len(data)
