"""A recording as its readers give it, whatever the file's format."""

from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import NamedTuple, Protocol, Self

from navette.bags.qos import OfferedQos


@dataclass(frozen=True)
class BagTopic:
    """A topic with one type; two types under one name are two of these.

    ROS 1 types are given in ROS 2's words.
    """

    name: str
    type_name: str
    """``pkg/msg/Name``."""

    definition: str = ""
    """``ros2msg`` text of the type as it was recorded; "" where the file has none."""

    type_hash: str = ""
    """``RIHS01_…`` as the file gives it, or ""."""

    qos: tuple[OfferedQos, ...] = ()
    """What its publishers offered; () where the file does not say."""

    encoding: str = "cdr"
    """How the messages are encoded; everything that ROS records comes as ``cdr``."""

    @property
    def latched(self) -> bool:
        """Whether who comes late was to get the last messages."""
        return any(each.durability == "transient_local" for each in self.qos)


class BagMessage(NamedTuple):
    """A message as it was on the wire: CDR with its 4-byte header."""

    topic: BagTopic
    stamp_ns: int
    """When it was heard."""
    data: bytes


@dataclass(frozen=True)
class Damage:
    """A part of a file that cannot be read."""

    path: Path
    position: int
    """Byte of the file."""
    reason: str

    def __str__(self) -> str:
        return f"{self.path}: byte {self.position}: {self.reason}"


OnDamage = Callable[[Damage], None]


class BagReader(Protocol):
    """An open recording; a context manager that closes it.

    Opening reads an index at most (or, where there is none, scans the file without
    unpacking it); messages are read as they are asked for, and only so much is held in
    memory as lies in chunks that overlap in time.
    """

    path: Path

    @property
    def storage(self) -> str:
        """``mcap``, ``rosbag1`` or ``sqlite3``."""

    @property
    def version(self) -> str:
        """Of the file's format, as its own tools say it."""

    @property
    def topics(self) -> tuple[BagTopic, ...]:
        """All topics, each with one type."""

    @property
    def problems(self) -> tuple[str, ...]:
        """What was found wrong on opening; what is sound can be read all the same."""

    @property
    def files(self) -> tuple[Path, ...]:
        """The files that hold messages."""

    @property
    def size(self) -> int:
        """Bytes of the files."""

    @property
    def start_ns(self) -> int:
        """Stamp of the first message; 0 without messages."""

    @property
    def end_ns(self) -> int:
        """Stamp of the last message; 0 without messages."""

    @property
    def compression(self) -> Mapping[str, int]:
        """Number of chunks (or files, or messages) by kind: ``none``, ``zstd``, …"""

    def counts(self) -> Mapping[BagTopic, int]:
        """Number of messages by topic; may have to look through the whole file."""

    def stamps(self) -> Iterator[tuple[BagTopic, int]]:
        """Topic and stamp of every message, in no particular order; fast."""

    def messages(
        self,
        topics: Collection[str] | None = None,
        *,
        start_ns: int | None = None,
        end_ns: int | None = None,
        on_damage: OnDamage | None = None,
    ) -> Iterator[BagMessage]:
        """The messages in the order of their stamps, equal ones as they lie.

        Args:
            topics: names to read; all if None.
            start_ns: first stamp.
            end_ns: last stamp, which is still given.
            on_damage: told of parts that cannot be read, which are then left out;
                without it they are an error.

        Raises:
            FileFormatError: a part of the file is damaged; names file and byte.
        """

    def close(self) -> None:
        """Close the files; twice is harmless."""

    def __enter__(self) -> Self: ...

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None: ...
