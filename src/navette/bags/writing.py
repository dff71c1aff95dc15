"""Write a recording in any of the supported formats."""

from pathlib import Path

from navette.bags.bag import BagMessage, BagTopic
from navette.bags.mcap_file import COMPRESSIONS
from navette.bags.replacing import make_way
from navette.bags.rosbags_writers import Db3Writer, Ros1Writer
from navette.bags.topic_writer import TopicWriter
from navette.bags.writer import BagWriter
from navette.errors import FileFormatError, InvalidValueError, UnknownNameError
from navette.msgs import definition_text, type_hash

STORAGES = ("mcap", "sqlite3", "rosbag1")
_BY_SUFFIX = {".mcap": "mcap", ".db3": "sqlite3", ".bag": "rosbag1"}


class McapWriter(TopicWriter):
    """Writes ``.mcap`` with the ``ros2`` profile; moved to its target when complete."""

    def __init__(self, path: Path, *, compression: str = "zstd") -> None:
        super().__init__(path)
        self._part = path.with_name(f".{path.name}.new")
        self._writer = BagWriter(self._part, compression=compression, overwrite=True)

    def _add(self, topic: BagTopic) -> int:
        return self._writer.add_topic(topic)

    def write(self, message: BagMessage) -> None:
        channel = self.channel_of(message.topic)
        try:
            self._writer.write(channel, message.stamp_ns, message.data)
        except OSError as error:
            raise self._error(error) from error
        self.message_count += 1

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
    path: Path, *, storage: str = "", compression: str = "", overwrite: bool = False
) -> TopicWriter:
    """Create a new recording.

    Args:
        storage: ``mcap``, ``sqlite3`` or ``rosbag1``; by default from the file name.
        compression: ``none``, ``zstd``, ``lz4`` or ``bz2``, if the format supports it;
            by default zstd for ``.mcap`` and none for others.

    Raises:
        FileFormatError: the file exists already, or cannot be created.
        InvalidValueError: unknown storage or compression.
    """
    storage = storage_of(path, storage)
    make_way(path, overwrite=overwrite)
    if not path.absolute().parent.is_dir():
        raise FileFormatError(path, "cannot be written: the folder does not exist")
    if storage == "mcap":
        return McapWriter(path, compression=compression or COMPRESSIONS[0])
    if storage == "sqlite3":
        return Db3Writer(path, compression=compression or "none")
    return Ros1Writer(path, compression=compression or "none")


def completed(topic: BagTopic) -> BagTopic:
    """Add Navette's definition to a topic without a recorded one."""
    if topic.definition or topic.encoding != "cdr":
        return topic
    try:
        text, known = definition_text(topic.type_name), type_hash(topic.type_name)
    except UnknownNameError:
        return topic
    return BagTopic(
        topic.name, topic.type_name, text, topic.type_hash or known, topic.qos
    )
