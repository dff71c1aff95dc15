"""Targets of a recording: one file, split files, or snapshots of the last seconds."""

from collections import Counter, deque
from dataclasses import dataclass, field
from pathlib import Path

from navette.bags.bag import BagTopic
from navette.bags.metadata import FileFacts, write_metadata
from navette.bags.writer import BagWriter
from navette.errors import FileFormatError


@dataclass(eq=False)
class RecordedTopic:
    """A topic, and its number of messages in the whole recording so far."""

    topic: BagTopic
    count: int = 0


class SingleFile:
    """One ``.mcap`` file.

    Raises:
        FileFormatError: the file cannot be created; names path and reason.

    All methods except :meth:`abandon` raise ``OSError`` if the disk is full or gone.
    """

    def __init__(
        self, path: Path, *, compression: str = "zstd", overwrite: bool = False
    ) -> None:
        self.path = path
        self._writer = BagWriter(path, compression=compression, overwrite=overwrite)
        self._channels: dict[RecordedTopic, int] = {}
        self.facts = FileFacts(path.name)

    @property
    def size(self) -> int:
        return self._writer.size

    def write(self, recorded: RecordedTopic, stamp_ns: int, payload: bytes) -> None:
        channel = self._channels.get(recorded)
        if channel is None:
            channel = self._channels[recorded] = self._writer.add_topic(recorded.topic)
        self._writer.write(channel, stamp_ns, payload)
        self.facts.add(stamp_ns)

    def flush(self) -> None:
        """Flush, so that written messages survive the end of this process."""
        self._writer.flush()

    def close(self) -> None:
        self._writer.close()

    def abandon(self) -> None:
        """Close after an ``OSError``."""
        self._writer.abandon()


class Folder:
    """A folder as of rosbag2: ``NAME/NAME_0.mcap``, …, metadata.yaml.

    Raises:
        FileFormatError: the folder exists already, or cannot be created.
    """

    def __init__(self, path: Path, *, compression: str = "zstd") -> None:
        self.path = path
        self._compression = compression
        try:
            path.mkdir()
        except FileExistsError:
            raise FileFormatError(path, "exists already and is not replaced") from None
        except OSError as error:
            raise FileFormatError(
                path, f"cannot be created: {error.strerror}"
            ) from error
        self.files: list[SingleFile] = []
        self._counts: Counter[RecordedTopic] = Counter()

    def next_file(self) -> SingleFile:
        name = f"{self.path.name}_{len(self.files)}.mcap"
        self.files.append(SingleFile(self.path / name, compression=self._compression))
        return self.files[-1]

    def note(self, recorded: RecordedTopic) -> None:
        self._counts[recorded] += 1

    def write_metadata(self) -> None:
        files = [file.facts for file in self.files]
        topics = [(each.topic, count) for each, count in self._counts.items()]
        write_metadata(self.path, files, topics)


class SplitFiles:
    """Files split by size or duration.

    Args:
        max_size: bytes of a file, 0 for no limit.
        max_duration_ns: between a file's first and last message, 0 for no limit.
    """

    def __init__(
        self,
        path: Path,
        *,
        compression: str = "zstd",
        max_size: int = 0,
        max_duration_ns: int = 0,
    ) -> None:
        self.path = path
        self._max_size = max_size
        self._max_duration_ns = max_duration_ns
        self._folder = Folder(path, compression=compression)
        self._file = self._folder.next_file()
        self._has_new_file = False
        self._is_closed = False

    def write(self, recorded: RecordedTopic, stamp_ns: int, payload: bytes) -> None:
        """Append a message, to a new file if the current one is full."""
        if self._is_full(stamp_ns, len(payload)):
            self._file.close()
            self._file = self._folder.next_file()
            self._has_new_file = True
        self._file.write(recorded, stamp_ns, payload)
        self._folder.note(recorded)

    def _is_full(self, stamp_ns: int, length: int) -> bool:
        facts = self._file.facts
        if facts.count == 0:
            return False
        if self._max_size and self._file.size + length > self._max_size:
            return True
        length_ns = stamp_ns - facts.start_ns
        return bool(self._max_duration_ns) and length_ns >= self._max_duration_ns

    def flush(self) -> None:
        """Flush, so that written messages survive the end of this process."""
        self._file.flush()
        # Not for each file: it names all of them, so that many small files would take
        # ever more time, in which the messages pile up.
        if self._has_new_file:
            self._has_new_file = False
            self._folder.write_metadata()

    def close(self) -> None:
        """Finish the last file and the metadata; a second call has no effect."""
        if not self._is_closed:
            self._is_closed = True
            self._file.close()
            self._folder.write_metadata()

    def abandon(self) -> None:
        """Close after an ``OSError``."""
        self._is_closed = True
        self._file.abandon()


@dataclass
class _Kept:
    recorded: RecordedTopic
    stamp_ns: int
    payload: bytes = field(repr=False)


class Snapshots:
    """Keeps the last seconds in memory and writes them on request.

    The last message of a latched topic is kept regardless of its age, for example the
    map.

    Args:
        duration_ns: duration to keep.
        max_bytes: memory limit.
    """

    def __init__(
        self,
        path: Path,
        *,
        duration_ns: int,
        max_bytes: int,
        compression: str = "zstd",
    ) -> None:
        self.path = path
        self._duration_ns = duration_ns
        self._max_bytes = max_bytes
        self._folder = Folder(path, compression=compression)
        self._kept: deque[_Kept] = deque()
        self._latched: dict[RecordedTopic, _Kept] = {}
        self._size = 0

    def write(self, recorded: RecordedTopic, stamp_ns: int, payload: bytes) -> None:
        self._kept.append(_Kept(recorded, stamp_ns, payload))
        self._size += len(payload)
        oldest_ns = stamp_ns - self._duration_ns
        while self._kept[0].stamp_ns < oldest_ns or self._size > self._max_bytes:
            gone = self._kept.popleft()
            self._size -= len(gone.payload)
            if gone.recorded.topic.latched:
                self._latched[gone.recorded] = gone
            if not self._kept:
                break

    def take(self) -> Path | None:
        """Write the stored messages to a new file; None without messages.

        Raises:
            OSError: the disk is full.
        """
        if not self._kept and not self._latched:
            return None
        file = self._folder.next_file()
        try:
            for each in (*self._latched.values(), *self._kept):
                file.write(each.recorded, each.stamp_ns, each.payload)
                self._folder.note(each.recorded)
            file.close()
        except OSError:
            file.abandon()
            raise
        self._folder.write_metadata()
        return file.path

    def flush(self) -> None:
        """Nothing to flush: snapshots are written on request."""

    def close(self) -> None:
        self._kept.clear()
        self._latched.clear()

    def abandon(self) -> None:
        self.close()


Recording = SingleFile | SplitFiles | Snapshots
