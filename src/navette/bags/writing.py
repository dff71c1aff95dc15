"""Write a recording in any of the supported formats."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from navette.bags.bag import (
    BagAttachment,
    BagMessage,
    BagTopic,
    MetadataRecord,
    RecordedMessage,
)
from navette.bags.db3_writer import Db3Writer
from navette.bags.mcap_file import COMPRESSIONS
from navette.bags.replacing import make_way
from navette.bags.ros1_writer import Ros1Writer
from navette.bags.topic_writer import TopicWriter, UnsupportedTopicError
from navette.bags.writer import BagWriter
from navette.errors import FileFormatError, InvalidValueError, UnknownNameError
from navette.msgs import definition_text, type_hash

STORAGES = ("mcap", "sqlite3", "rosbag1")
_BY_SUFFIX = {".mcap": "mcap", ".db3": "sqlite3", ".bag": "rosbag1"}


class McapWriter(TopicWriter):
    """Writes ``.mcap``; moved to its target when complete."""

    keeps_encoding = True

    def __init__(
        self, path: Path, *, compression: str = "zstd", profile: str = "ros2"
    ) -> None:
        super().__init__(path)
        self._part = path.with_name(f".{path.name}.new")
        self._writer = BagWriter(
            self._part, compression=compression, overwrite=True, profile=profile
        )

    def add_attachment(self, attachment: BagAttachment) -> None:
        self._on_disk(lambda: self._writer.add_attachment(attachment))

    def add_metadata(self, record: MetadataRecord) -> None:
        self._on_disk(lambda: self._writer.add_metadata(record))

    def _add(self, topic: BagTopic) -> int:
        try:
            return self._writer.add_topic(topic)
        except InvalidValueError as error:
            raise UnsupportedTopicError(self.path, str(error)) from error

    def write(self, message: BagMessage | RecordedMessage) -> None:
        channel = self.channel_of(message.topic)
        if message.stamp_ns < 0:
            self.losses.add("messages with a stamp before 1970", message.topic.name)
            return
        try:
            if isinstance(message, RecordedMessage):
                self._writer.write_recorded(channel, message)
            else:
                self._writer.write(channel, message.stamp_ns, message.data)
        except OSError as error:
            raise self._error(error) from error
        self.message_count += 1

    def _on_disk(self, work: Callable[[], None]) -> None:
        try:
            work()
        except OSError as error:
            raise self._error(error) from error

    def close(self) -> None:
        try:
            self._writer.close()
            self._part.replace(self.path)
        except OSError as error:
            self.abandon()
            raise self._error(error) from error

    def abandon(self) -> None:
        self._writer.abandon()
        self._part.unlink(missing_ok=True)


def storage_of(path: Path, storage: str = "") -> str:
    """Return the storage format, as given or by the file name.

    Raises:
        InvalidValueError: neither determines it.
    """
    if storage:
        if storage not in STORAGES:
            known = ", ".join(STORAGES)
            raise InvalidValueError(f"storage {storage!r}; known: {known}")
        return storage
    found = _BY_SUFFIX.get(path.suffix)
    if found is None:
        raise InvalidValueError(
            f"{path}: use a name that ends in .mcap, .db3 or .bag, "
            f"or --storage: {', '.join(STORAGES)}"
        )
    return found


def open_writer(
    path: Path,
    *,
    storage: str = "",
    compression: str = "",
    overwrite: bool = False,
    profile: str = "ros2",
) -> TopicWriter:
    """Create a new recording.

    Args:
        storage: ``mcap``, ``sqlite3`` or ``rosbag1``; by default from the file name.
        compression: ``none``, ``zstd``, ``lz4`` or ``bz2``, if the format supports it;
            by default zstd for ``.mcap`` and none for others.
        profile: of an ``.mcap`` file's header.

    Raises:
        FileFormatError: the file exists already, or cannot be created.
        InvalidValueError: unknown storage or compression.
    """
    storage = storage_of(path, storage)
    make_way(path, overwrite=overwrite)
    if not path.absolute().parent.is_dir():
        raise FileFormatError(path, "cannot be written: the folder does not exist")
    if storage == "mcap":
        return McapWriter(
            path, compression=compression or COMPRESSIONS[0], profile=profile
        )
    if storage == "sqlite3":
        return Db3Writer(path, compression=compression or "none")
    return Ros1Writer(path, compression=compression or "none")


def completed(topic: BagTopic) -> BagTopic:
    """Add Navette's definition to a topic whose file has none."""
    if topic.definition or topic.encoding != "cdr" or topic.channel is not None:
        return topic
    try:
        text, known = definition_text(topic.type_name), type_hash(topic.type_name)
    except UnknownNameError:
        return topic
    return replace(topic, definition=text, type_hash=topic.type_hash or known)
