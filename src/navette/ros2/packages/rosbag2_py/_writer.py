"""Writer of a new bag."""

import weakref
from pathlib import Path

from navette.bags import BagMessage, BagTopic
from navette.bags.qos_profiles import offer_of
from navette.bags.recording import RecordedTopic, SplitFiles
from navette.bags.writing import completed, open_writer
from navette.errors import InvalidValueError
from navette.ros2.packages.rosbag2_py._storage import (
    ConverterOptions,
    StorageOptions,
    TopicMetadata,
)

_FORMATS = ("", "cdr")


class _OneDatabase:
    """A folder with one SQLite file."""

    def __init__(self, options: StorageOptions) -> None:
        if options.max_bagfile_size or options.max_bagfile_duration:
            raise InvalidValueError(
                "max_bagfile_size, max_bagfile_duration: a bag of storage 'sqlite3' is "
                "one file; 'mcap' can be split"
            )
        self._writer = open_writer(Path(options.uri), storage="sqlite3")

    def write(self, recorded: RecordedTopic, stamp_ns: int, payload: bytes) -> None:
        self._writer.write(BagMessage(recorded.topic, stamp_ns, payload))

    def close(self) -> None:
        self._writer.close()


class SequentialWriter:
    """Writes a folder with ``metadata.yaml`` and MCAP or SQLite files, as rosbag2 does.

    The bag is complete after :meth:`close`, or when the writer is deleted.
    """

    def __init__(self) -> None:
        self._files: SplitFiles | _OneDatabase | None = None
        self._topics: dict[str, RecordedTopic] = {}

    def open(
        self,
        storage_options: StorageOptions,
        converter_options: ConverterOptions | None = None,
    ) -> None:
        """Create a bag.

        Raises:
            FileFormatError: the folder exists already, or cannot be created.
            InvalidValueError: a storage or a format that cannot be written.
        """
        if storage_options.storage_id not in ("", *get_registered_writers()):
            raise InvalidValueError(
                f"storage_id {storage_options.storage_id!r}: bags are written as "
                "'mcap' or 'sqlite3'; navette bag convert makes other formats"
            )
        wanted = (converter_options or ConverterOptions()).output_serialization_format
        if wanted not in _FORMATS:
            raise InvalidValueError(
                f"output_serialization_format {wanted!r}: messages are written as 'cdr'"
            )
        self.close()
        if storage_options.storage_id == "sqlite3":
            self._files = _OneDatabase(storage_options)
        else:
            self._files = SplitFiles(
                Path(storage_options.uri),
                max_size=storage_options.max_bagfile_size,
                max_duration_ns=storage_options.max_bagfile_duration * 1_000_000_000,
            )
        # Programs often end without closing their writer.
        self._close = weakref.finalize(self, self._files.close)

    def create_topic(self, topic: TopicMetadata) -> None:
        """Announce a topic, before its first message.

        Raises:
            RuntimeError: no bag is open.
        """
        self._opened()
        profiles = topic.offered_qos_profiles
        qos = tuple(offer_of(profile) for profile in profiles)
        described = BagTopic(
            topic.name, topic.type, type_hash=topic.type_description_hash, qos=qos
        )
        self._topics.setdefault(topic.name, RecordedTopic(completed(described)))

    def remove_topic(self, topic: TopicMetadata) -> None:
        """Refuse further messages of a topic; those written remain."""
        self._topics.pop(topic.name, None)

    def write(self, topic_name: str, message: bytes, time_stamp: int) -> None:
        """Append a serialized message with its time of reception (ns).

        Raises:
            RuntimeError: no bag is open, or the topic was not created.
            OSError: the disk is full.
        """
        files = self._opened()
        recorded = self._topics.get(topic_name)
        if recorded is None:
            raise RuntimeError(
                f"Topic '{topic_name}' has not been created yet! Call 'create_topic' "
                "first."
            )
        files.write(recorded, time_stamp, bytes(message))

    def close(self) -> None:
        """Finish the bag; a second call has no effect."""
        if self._files is not None:
            self._close()
        self._files, self._topics = None, {}

    def _opened(self) -> SplitFiles | _OneDatabase:
        if self._files is None:
            raise RuntimeError("Bag is not open. Call open() before writing.")
        return self._files


class SequentialCompressionWriter(SequentialWriter):
    """As :class:`SequentialWriter`, whose chunks are compressed already."""


def get_registered_writers() -> set[str]:
    """Return the storages that can be written."""
    return {"mcap", "sqlite3"}


def get_registered_compressors() -> set[str]:
    """Return the compressions of a bag's files: none, MCAP compresses chunks."""
    return set()


def get_registered_serializers() -> set[str]:
    """Return the formats beside CDR: none."""
    return set()
