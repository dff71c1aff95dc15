"""Write rosbag2's SQLite files, schema 4 (Iron to Kilted), as files or folders.

Source: rosbag2_storage_sqlite3. Messages are stored as they are, so no definition of
their type is required.
"""

import sqlite3
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory

import yaml
import zstandard

from navette.bags.bag import BagMessage, BagTopic, RecordedMessage
from navette.bags.metadata import VERSION, FileFacts, information, write_metadata
from navette.bags.qos import qos_text
from navette.bags.topic_writer import (
    TopicWriter,
    UnsupportedTopicError,
    other_metadata,
)
from navette.errors import InvalidValueError

_TABLES = """
CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);
CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL,
  metadata TEXT NOT NULL);
CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,
  serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL,
  type_description_hash TEXT NOT NULL);
CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL,
  encoding TEXT NOT NULL, encoded_message_definition TEXT NOT NULL,
  type_description_hash TEXT NOT NULL);
CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL,
  timestamp INTEGER NOT NULL, data BLOB NOT NULL);
INSERT INTO schema VALUES (4, 'navette');
"""
_INDEX = "CREATE INDEX timestamp_idx ON messages (timestamp ASC)"
_INSERT = "INSERT INTO messages (topic_id, timestamp, data) VALUES (?, ?, ?)"
_LAST_NS = 2**63 - 1


class Db3Writer(TopicWriter):
    """Writes a ``.db3`` file, or a folder with ``metadata.yaml``.

    Args:
        path: a name with the suffix ``.db3`` is a single file, others are a folder.
        compression: ``none``, or ``zstd`` of the whole file (folders only).
    """

    def __init__(self, path: Path, *, compression: str = "none") -> None:
        super().__init__(path)
        self._is_file = path.suffix == ".db3"
        if compression not in ("none", "zstd") or (
            self._is_file and compression != "none"
        ):
            raise InvalidValueError(
                f"compression {compression!r} of SQLite; known: none, and zstd in a "
                "folder (a name without .db3)"
            )
        self._is_packed = compression == "zstd"
        self._facts = FileFacts(f"{path.stem}.db3")
        self._counts: dict[int, int] = {}
        self._topics: list[BagTopic] = []
        self._numbers: dict[tuple[str, str, str], int] = {}
        self._types: set[str] = set()
        try:
            # Written beside the target, so that the target is complete or absent.
            self._temporary = TemporaryDirectory(prefix=".navette-", dir=path.parent)
            self._folder = Path(self._temporary.name) / path.stem
            self._folder.mkdir()
            self._database = sqlite3.connect(self._folder / self._facts.name)
            self._database.executescript(_TABLES)
        except (OSError, sqlite3.Error) as error:
            raise self._error(error) from error

    def write(self, message: BagMessage | RecordedMessage) -> None:
        number = self.channel_of(message.topic)
        if not -_LAST_NS <= message.stamp_ns <= _LAST_NS:
            self.losses.add("messages with a stamp after 2262", message.topic.name)
            return
        row = number, message.stamp_ns, message.data
        try:
            self._database.execute(_INSERT, row)
        except (sqlite3.Error, OverflowError) as error:
            raise self._error(error) from error
        self._note_losses(message)
        self._facts.add(message.stamp_ns)
        self._counts[number] += 1
        self.message_count += 1

    def _add(self, topic: BagTopic) -> int:
        """Return the number of a topic; channels that differ otherwise share it."""
        key = topic.name, topic.type_name, topic.encoding
        if other := other_metadata(topic):
            self.losses.add("channel metadata entries", topic.name, len(other))
        if key not in self._numbers:
            number = self._numbers[key] = len(self._topics) + 1
            try:
                self._insert(number, topic)
            except (sqlite3.Error, UnicodeError) as error:
                raise UnsupportedTopicError(
                    self.path, f"{topic.name!r}: {error}"
                ) from error
            self._topics.append(topic)
            self._counts[number] = 0
        return self._numbers[key]

    def _insert(self, number: int, topic: BagTopic) -> None:
        encoding, text = _definition(topic)
        if topic.type_name not in self._types:
            self._types.add(topic.type_name)
            self._database.execute(
                "INSERT INTO message_definitions (topic_type, encoding,"
                " encoded_message_definition, type_description_hash)"
                " VALUES (?, ?, ?, ?)",
                (topic.type_name, encoding, text, topic.type_hash),
            )
        self._database.execute(
            "INSERT INTO topics VALUES (?, ?, ?, ?, ?, ?)",
            (
                *(number, topic.name, topic.type_name, topic.encoding),
                *(qos_text(topic.qos), topic.type_hash),
            ),
        )

    def close(self) -> None:
        try:
            self._finish()
            made = self._folder / self._facts.name if self._is_file else self._folder
            made.replace(self.path)
        except (sqlite3.Error, OSError) as error:
            raise self._error(error) from error
        finally:
            self._database.close()
            self._temporary.cleanup()

    def _finish(self) -> None:
        topics = [(each, self._counts[n]) for n, each in enumerate(self._topics, 1)]
        found = information([self._facts], topics, storage="sqlite3")
        text = yaml.safe_dump(found, sort_keys=False)
        self._database.execute(
            "INSERT INTO metadata (metadata_version, metadata) VALUES (?, ?)",
            (VERSION, text),
        )
        self._database.execute(_INDEX)
        self._database.commit()
        self._database.close()
        if self._is_packed:
            self._pack()
        if not self._is_file:
            kind = "zstd" if self._is_packed else ""
            write_metadata(
                self._folder,
                [self._facts],
                topics,
                storage="sqlite3",
                compression=kind,
            )

    def _pack(self) -> None:
        plain = self._folder / self._facts.name
        self._facts.name += ".zstd"
        with (
            plain.open("rb") as source,
            (self._folder / self._facts.name).open("wb") as target,
        ):
            zstandard.ZstdCompressor().copy_stream(source, target)
        plain.unlink()

    def abandon(self) -> None:
        with suppress(sqlite3.Error):
            self._database.close()
        self._temporary.cleanup()


def _definition(topic: BagTopic) -> tuple[str, str | bytes]:
    """Return encoding and text of a topic's definition, as recorded if possible."""
    recorded = topic.channel
    if (
        recorded is None
        or recorded.schema is None
        or recorded.encoding != topic.encoding
    ):
        return ("ros2msg" if topic.definition else "unknown"), topic.definition
    try:
        return recorded.schema_encoding, recorded.schema.decode()
    except UnicodeDecodeError:  # such as a protobuf descriptor
        return recorded.schema_encoding, recorded.schema
