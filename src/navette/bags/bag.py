"""Interface of an open recording, independent of the file format."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple, Self

from navette.bags.qos import OfferedQos


@dataclass(frozen=True)
class BagTopic:
    """A topic with one type; one name with two types gives two of these.

    ROS 1 types have ROS 2's names.
    """

    name: str
    type_name: str
    """``pkg/msg/Name``."""

    definition: str = ""
    """Recorded ``ros2msg`` definition of the type; "" if the file has none."""

    type_hash: str = ""
    """``RIHS01_…`` as recorded, or ""."""

    qos: tuple[OfferedQos, ...] = ()
    """QoS offered by the publishers; () if not recorded."""

    encoding: str = "cdr"
    """Encoding of the messages; ``cdr`` for everything recorded by ROS."""

    @property
    def latched(self) -> bool:
        """Whether late subscribers received the last messages (transient local)."""
        return any(each.durability == "transient_local" for each in self.qos)


class BagMessage(NamedTuple):
    """A serialized message: CDR with its 4-byte header."""

    topic: BagTopic
    stamp_ns: int
    """Time of reception."""
    data: bytes


@dataclass(frozen=True)
class Damage:
    """A part of a file that cannot be read."""

    path: Path
    position: int
    """Offset in the file, bytes."""
    reason: str

    def __str__(self) -> str:
        return f"{self.path}: byte {self.position}: {self.reason}"


OnDamage = Callable[[Damage], None]


class BagReader(ABC):
    """An open recording; a context manager that closes it.

    Opening reads the index only (or, without one, scans the file without decompressing
    it). Messages are read on demand; memory holds only chunks that overlap in time.
    """

    path: Path
    storage: str
    """``mcap``, ``rosbag1`` or ``sqlite3``."""
    version: str
    """Version of the file format, as reported by its own tools."""
    topics: tuple[BagTopic, ...] = ()
    """All topics, each with one type."""
    problems: tuple[str, ...] = ()
    """Problems found on opening; intact parts can be read."""
    size: int
    """Total size of the files, bytes."""
    start_ns: int
    """Stamp of the first message; 0 without messages."""
    end_ns: int
    """Stamp of the last message; 0 without messages."""

    @property
    def files(self) -> tuple[Path, ...]:
        """The files with messages."""
        return (self.path,)

    @property
    @abstractmethod
    def compression(self) -> Mapping[str, int]:
        """Number of chunks (or files, or messages) by kind: ``none``, ``zstd``, …"""

    @abstractmethod
    def counts(self) -> Mapping[BagTopic, int]:
        """Number of messages by topic; may scan the whole file."""

    @abstractmethod
    def stamps(self) -> Iterator[tuple[BagTopic, int]]:
        """Topic and stamp of every message, in no particular order; fast."""

    @abstractmethod
    def messages(
        self,
        topics: Collection[str] | None = None,
        *,
        start_ns: int | None = None,
        end_ns: int | None = None,
        on_damage: OnDamage | None = None,
    ) -> Iterator[BagMessage]:
        """Iterate over the messages by stamp, equal stamps in file order.

        Args:
            topics: names to read; all if None.
            start_ns: first stamp.
            end_ns: last stamp, included.
            on_damage: called for parts that cannot be read, which are then skipped;
                without it they are an error.

        Raises:
            FileFormatError: a part of the file is damaged; names file and byte.
        """

    @abstractmethod
    def close(self) -> None:
        """Close the files; a second call has no effect."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()
