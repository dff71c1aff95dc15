"""Bag files: MCAP with ROS 2's profile, as rosbag2 writes it.

Source: the MCAP specification and its ``ros2`` profile (foxglove/mcap). Made so that
the same messages give the same bytes: no wall clock, no random number and no
version of a library goes into the file; chunks end by size and by :meth:`flush`,
which the caller must tie to message time.

Why chunks and not records of their own: compressed chunks are four to ten times
smaller, and a chunk is what readers seek by. What is not yet in a finished chunk is
lost with the process, so flush often.
"""

from contextlib import suppress
from pathlib import Path
from typing import Any

from mcap.writer import CompressionType, Writer

from navette.errors import FileFormatError

_CHUNK_BYTES = 256 * 1024
# Larger than any chunk: a chunk and its index reach the system in one piece.
_BUFFER_BYTES = 4 * 2**20
_LIBRARY = "navette"


class BagWriter:
    """Writes one ``.mcap`` file; an existing file is replaced.

    Raises:
        FileFormatError: the file cannot be made; names path and reason.

    Later a full or vanished disk shows as ``OSError`` from any method but
    :meth:`abandon`.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        try:
            self._file = path.open("wb", buffering=_BUFFER_BYTES)
        except OSError as error:
            reason = error.strerror or str(error)
            raise FileFormatError(path, f"cannot be written: {reason}") from error
        # Any: several of mcap's methods carry no types.
        self._mcap: Any = Writer(
            # Chunks are ended here, so that each is handed on as soon as it is done.
            self._file,
            chunk_size=_BUFFER_BYTES,
            compression=CompressionType.ZSTD,
        )
        self._mcap.start(profile="ros2", library=_LIBRARY)
        self._schemas: dict[str, int] = {}
        self._sequences: dict[int, int] = {}
        self._unfinished = 0

    def add_channel(
        self,
        topic: str,
        type_name: str,
        definition: str,
        *,
        type_hash: str = "",
        qos: str = "",
    ) -> int:
        """Announce a topic; gives the channel's number for :meth:`write`.

        Args:
            definition: ros2msg text of the type and all types it holds.
            type_hash: ``RIHS01_…``.
            qos: what its publishers offer, see :func:`navette.bags.qos_text`.
        """
        schema = self._schemas.get(type_name)
        if schema is None:
            schema = self._mcap.register_schema(
                type_name, "ros2msg", definition.encode()
            )
            self._schemas[type_name] = schema
        channel: int = self._mcap.register_channel(
            topic,
            "cdr",
            schema,
            {"offered_qos_profiles": qos, "topic_type_hash": type_hash},
        )
        self._sequences[channel] = 0
        return channel

    def write(self, channel: int, stamp_ns: int, payload: bytes) -> None:
        """Append a message: CDR with its 4-byte header, and when it was heard."""
        sequence = self._sequences[channel] + 1
        self._sequences[channel] = sequence
        self._mcap.add_message(channel, stamp_ns, payload, stamp_ns, sequence)
        self._unfinished += len(payload)
        if self._unfinished > _CHUNK_BYTES:
            self.flush()

    @property
    def message_count(self) -> int:
        """Messages written so far."""
        return sum(self._sequences.values())

    def flush(self) -> None:
        """Finish the chunk and hand it to the system: it outlives this process."""
        self._unfinished = 0
        self._mcap.flush()

    def close(self) -> None:
        """Write the index and close; closing twice is harmless."""
        if not self._file.closed:
            self._mcap.finish()
            self._file.close()

    def abandon(self) -> None:
        """Close after an ``OSError``; what was flushed stays readable."""
        with suppress(OSError):  # the same error again; it is known already
            self._file.close()
