"""Read rosbag2's SQLite files, all schemas from Eloquent to Lyrical.

Source: rosbag2_storage_sqlite3. SQLite iterates over the index of stamps, so that the
first message is available at once and nothing is held in memory. Uses Python's
``sqlite3``; databases are opened read-only.
"""

import sqlite3
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple
from urllib.parse import quote

from navette.bags.bag import (
    BagMessage,
    BagReader,
    BagTopic,
    Damage,
    MessageQuery,
    OnDamage,
    RecordedChannel,
)
from navette.bags.compression import LARGEST, is_zstd, unpack_zstd_message
from navette.bags.definitions import msg_text, ros2_name
from navette.bags.qos import parse_qos
from navette.errors import DecodeError, FileFormatError
from navette.files.untrusted.files import open_regular

MAGIC = b"SQLite format 3\0"
_SMALLEST_ROW = 16  # minimum bytes of a row; bounds the number of rows
_LOG_SUFFIX = "-wal"
# Error texts of SQLite may contain damaged bytes that are not UTF-8.
_ERRORS = (sqlite3.Error, UnicodeDecodeError, OverflowError)
_DATA = "SELECT data FROM messages WHERE id = ?"


class _Row(NamedTuple):
    id: int
    topic: int
    stamp_ns: int


class Db3Reader(BagReader):
    """An open ``.db3`` file.

    Raises:
        FileFormatError: the file does not exist or is not a rosbag2 recording.
    """

    storage = "sqlite3"

    def __init__(self, path: Path) -> None:
        self.path = path
        self.version = "1"
        self.start_ns = self.end_ns = 0
        self._topic_of: dict[int, BagTopic] = {}
        self._counts: dict[BagTopic, int] | None = None
        self._database = self._connect()
        try:
            self.size = path.stat().st_size
            self._read_head()
        except (*_ERRORS, FileFormatError) as error:
            self.close()
            if isinstance(error, FileFormatError):
                raise
            raise FileFormatError(path, f"cannot be read: {error}") from error

    @property
    def compression(self) -> Mapping[str, int]:
        return {"none": 1}

    def close(self) -> None:
        self._database.close()

    def counts(self) -> Mapping[BagTopic, int]:
        if self._counts is None:
            query = "SELECT topic_id, count(*) FROM messages GROUP BY topic_id"
            self._counts = dict.fromkeys(self.topics, 0)
            for number, count in self._rows(query):
                if number in self._topic_of:
                    self._counts[self._topic_of[number]] += count
        return self._counts

    def stamps(self) -> Iterator[tuple[BagTopic, int]]:
        for number, stamp in self._rows("SELECT topic_id, timestamp FROM messages"):
            if number in self._topic_of and isinstance(stamp, int):
                yield self._topic_of[number], stamp

    def read(self, query: MessageQuery) -> Iterator[BagMessage]:
        names, start_ns, end_ns, on_damage = query
        wanted = {
            number
            for number, topic in self._topic_of.items()
            if names is None or topic.name in names
        }
        last = 0, -(2**63)  # number of rows read of the last stamp
        try:
            for row, data in self._in_order(start_ns, end_ns):
                last = (last[0] + 1 if row.stamp_ns == last[1] else 1), row.stamp_ns
                if row.topic in wanted:
                    message = self._message(row, data, on_damage)
                    if message is not None:
                        yield message
        except _ERRORS as error:
            reason = f"damaged after the message at {last[1]} ns: {error}"
            if on_damage is None:
                raise FileFormatError(self.path, reason) from error
            on_damage(Damage(self.path, 0, reason))
            yield from self._salvage(wanted, start_ns, end_ns, last, on_damage)

    def integrity(self) -> Iterator[str]:
        """Return the problems that SQLite finds in the database."""
        try:
            for (line,) in self._database.execute("PRAGMA integrity_check(20)"):
                if line != "ok":
                    yield str(line)
            query = "SELECT count(*) FROM messages WHERE topic_id NOT IN"
            count = self._database.execute(f"{query} (SELECT id FROM topics)")
            (unknown,) = count.fetchone()
            if unknown:
                yield f"messages of an undefined topic: {unknown}"
        except _ERRORS as error:
            yield str(error)

    # -- opening -------------------------------------------------------------------

    def _connect(self) -> sqlite3.Connection:
        """Open read-only, including the write-ahead log of a killed recorder."""
        path = self.path
        with open_regular(path) as file:
            if file.read(len(MAGIC)) != MAGIC:
                raise FileFormatError(path, "is not an SQLite database")
        uri = f"file:{quote(str(path.absolute()))}?mode=ro"
        log = path.with_name(path.name + _LOG_SUFFIX)
        if log.exists() and log.stat().st_size:
            try:
                return _open(uri)
            except _ERRORS as error:
                self.problems += (f"{log.name} cannot be read: {error}",)
        try:
            return _open(f"{uri}&immutable=1")
        except _ERRORS as error:
            raise FileFormatError(path, f"cannot be opened: {error}") from error

    def _read_head(self) -> None:
        tables = dict(self._database.execute("SELECT name, type FROM sqlite_master"))
        for table in ("messages", "topics"):
            if tables.get(table) != "table":
                raise FileFormatError(
                    self.path, f"is not a rosbag2 recording: table {table!r} is missing"
                )
        columns = self._columns("topics")
        if "schema" in tables:
            found = self._database.execute("SELECT schema_version FROM schema")
            self.version = str((found.fetchone() or ("?",))[0])
        elif "offered_qos_profiles" in columns:
            self.version = "2"
        definitions = self._definitions() if "message_definitions" in tables else {}
        self._read_topics(columns, definitions)
        first, last = self._database.execute(
            "SELECT (SELECT min(timestamp) FROM messages),"
            " (SELECT max(timestamp) FROM messages)"
        ).fetchone()
        if isinstance(first, int) and isinstance(last, int):
            self.start_ns, self.end_ns = first, last

    def _columns(self, table: str) -> set[str]:
        return {row[1] for row in self._database.execute(f"PRAGMA table_info({table})")}

    def _definitions(self) -> dict[str, tuple[str, bytes]]:
        query = "SELECT topic_type, encoding, encoded_message_definition"
        return {
            str(name): (str(encoding), _octets(text))
            for name, encoding, text in self._database.execute(
                f"{query} FROM message_definitions"
            )
        }

    def _read_topics(
        self, columns: set[str], definitions: dict[str, tuple[str, bytes]]
    ) -> None:
        optional = [
            name if name in columns else "''"
            for name in ("offered_qos_profiles", "type_description_hash")
        ]
        query = f"SELECT id, name, type, serialization_format, {', '.join(optional)}"
        for number, name, type_name, encoding, qos, hash_ in self._database.execute(
            f"{query} FROM topics ORDER BY id"
        ):
            schema_encoding, schema = _definition_of(str(type_name), definitions)
            metadata = {
                "offered_qos_profiles": str(qos or ""),
                "topic_type_hash": str(hash_ or ""),
            }
            recorded = RecordedChannel(
                str(encoding),
                str(type_name),
                schema_encoding,
                schema,
                tuple(metadata.items()),
            )
            try:
                text = msg_text(recorded)
            except FileFormatError as error:
                self.remarks += (str(error),)
                text = ""
            self._topic_of[number] = BagTopic(
                str(name),
                ros2_name(str(type_name)) if encoding == "cdr" else str(type_name),
                text,
                str(hash_ or ""),
                parse_qos(qos),
                str(encoding),
                recorded if schema_encoding else None,
            )
        self.topics = tuple(dict.fromkeys(self._topic_of.values()))

    # -- messages ------------------------------------------------------------------

    def _in_order(
        self, start_ns: int | None, end_ns: int | None
    ) -> Iterator[tuple[_Row, Any]]:
        limits = [-(2**63) if start_ns is None else start_ns]
        limits.append(2**63 - 1 if end_ns is None else end_ns)
        where = "WHERE timestamp BETWEEN ? AND ? ORDER BY timestamp, id"
        if self._has_index():
            query = f"SELECT id, topic_id, timestamp, data FROM messages {where}"
            for number, topic, stamp, data in self._database.execute(query, limits):
                yield self._row(number, topic, stamp), data
            return
        # SQLite sorts first, without the data column.
        query = f"SELECT id, topic_id, timestamp FROM messages {where}"
        for number, topic, stamp in self._database.execute(query, limits):
            yield self._row(number, topic, stamp), self._data(number)

    def _has_index(self) -> bool:
        query = "SELECT 1 FROM messages ORDER BY timestamp, id"
        plan = self._database.execute(f"EXPLAIN QUERY PLAN {query}").fetchall()
        return not any("TEMP B-TREE" in str(row[-1]) for row in plan)

    def _row(self, number: object, topic: object, stamp: object) -> _Row:
        if (
            not isinstance(number, int)
            or not isinstance(topic, int)
            or not isinstance(stamp, int)
        ):
            raise sqlite3.DatabaseError(f"row {number!r} has no stamp or topic")
        return _Row(number, topic, stamp)

    def _data(self, number: int) -> Any:
        found = self._database.execute(_DATA, (number,)).fetchone()
        return found[0] if found else None

    def _message(
        self, row: _Row, data: object, on_damage: OnDamage | None
    ) -> BagMessage | None:
        try:
            if not isinstance(data, bytes):
                raise DecodeError("no data")
            if is_zstd(data) and self._topic_of[row.topic].encoding == "cdr":
                data = unpack_zstd_message(data)
        except DecodeError as error:
            reason = f"message {row.id} at {row.stamp_ns} ns: {error}"
            if on_damage is None:
                raise FileFormatError(self.path, reason) from error
            on_damage(Damage(self.path, 0, reason))
            return None
        return BagMessage(self._topic_of[row.topic], row.stamp_ns, data)

    def _salvage(
        self,
        wanted: set[int],
        start_ns: int | None,
        end_ns: int | None,
        last: tuple[int, int],
        on_damage: OnDamage,
    ) -> Iterator[BagMessage]:
        """Read row by row after the index of stamps failed."""
        rows = sorted(
            row
            for row in self._readable_rows()
            if (start_ns is None or row.stamp_ns >= start_ns)
            and (end_ns is None or row.stamp_ns <= end_ns)
        )
        rows.sort(key=lambda row: (row.stamp_ns, row.id))
        skip = last[0]
        for row in rows:
            if row.stamp_ns < last[1] or (row.stamp_ns == last[1] and skip > 0):
                skip -= row.stamp_ns == last[1]
                continue
            if row.topic in wanted:
                found = self._attempt(_DATA, row.id)
                message = self._message(row, found and found[0], on_damage)
                if message is not None:
                    yield message

    def _readable_rows(self) -> Iterator[_Row]:
        query = "SELECT id, topic_id, timestamp FROM messages WHERE id = ?"
        highest = self._attempt("SELECT max(id) FROM messages WHERE id > ?", 0)
        most = self.size // _SMALLEST_ROW
        if highest is not None and isinstance(highest[0], int):
            most = min(most, highest[0])
        for number in range(1, most + 1):
            found = self._attempt(query, number)
            if found is not None and all(isinstance(each, int) for each in found):
                yield _Row(*found)

    def _rows(self, query: str) -> Iterator[Any]:
        """Iterate over rows up to the first that cannot be read."""
        try:
            yield from self._database.execute(query)
        except _ERRORS as error:
            self.problems += (f"cannot be read to the end: {error}",)

    def _attempt(self, query: str, number: int) -> Any:
        """Read one row; None if it does not exist or cannot be read."""
        try:
            return self._database.execute(query, (number,)).fetchone()
        except _ERRORS:
            return None


def _open(uri: str) -> sqlite3.Connection:
    # A player reads ahead in a thread; SQLite takes turns by itself.
    database = sqlite3.connect(uri, uri=True, check_same_thread=False)
    try:
        database.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, LARGEST)
        database.text_factory = _text
        database.execute("PRAGMA trusted_schema = OFF")
        database.execute("SELECT count(*) FROM sqlite_master").fetchone()
    except BaseException:
        database.close()
        raise
    return database


def _text(data: bytes) -> str:
    return data.decode("utf-8", "replace")


def _octets(text: object) -> bytes:
    return text if isinstance(text, bytes) else str(text or "").encode()


def _definition_of(
    type_name: str, definitions: Mapping[str, tuple[str, bytes]]
) -> tuple[str, bytes | None]:
    """Return encoding and text of a type; rosbag2 stores that of an event's service."""
    found = definitions.get(type_name)
    if found is None and type_name.endswith("_Event"):
        found = definitions.get(type_name.removesuffix("_Event"))
    return found or ("", None)
