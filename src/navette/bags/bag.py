"""Interface of an open recording, independent of the file format."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import NamedTuple, Self

from navette.bags.qos import OfferedQos

Convert = Callable[[bytes], bytes]
"""Converts a recorded message to CDR."""


@dataclass(frozen=True)
class RecordedChannel:
    """A topic as its file describes it, for copies that keep everything."""

    encoding: str
    """Encoding of the messages: ``cdr``, ``ros1``, ``json``, …"""

    schema_name: str = ""
    schema_encoding: str = ""
    """``ros2msg``, ``ros2idl``, ``ros1msg``, ``jsonschema``, ``protobuf``, …"""
    schema: bytes | None = None
    """The definition; None if the channel has no schema."""

    metadata: tuple[tuple[str, str], ...] = ()

    to_cdr: Convert | None = field(default=None, compare=False)
    """Conversion of a recorded message to CDR; None if it is not converted."""


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

    channel: RecordedChannel | None = None
    """As described in the file, if the file describes it."""

    @cached_property
    def as_recorded(self) -> "BagTopic":
        """The topic with the encoding of its recorded messages."""
        if self.channel is None or self.channel.encoding == self.encoding:
            return self
        return replace(self, encoding=self.channel.encoding)

    _hash: int = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        # Once: topics are the keys of every count.
        parts = (self.name, self.type_name, self.type_hash, self.encoding, self.channel)
        object.__setattr__(self, "_hash", hash(parts))

    def __hash__(self) -> int:
        return self._hash

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


class RecordedMessage(NamedTuple):
    """A message with everything that was recorded, in its recorded encoding."""

    topic: BagTopic
    stamp_ns: int
    data: bytes
    publish_ns: int | None = None
    """Time of publication; None if not recorded."""
    sequence: int | None = None
    """Number given by the publisher or recorder; None if not recorded."""


ReadBlocks = Callable[[], Iterator[bytes]]
"""Reads the content of an attachment in parts; raises FileFormatError if damaged."""


class BagAttachment(NamedTuple):
    """A file inside a recording."""

    name: str
    media_type: str
    size: int
    """Bytes of its content."""
    log_ns: int
    create_ns: int
    blocks: ReadBlocks


class MetadataRecord(NamedTuple):
    """Named texts about a recording."""

    name: str
    values: Mapping[str, str]


@dataclass(frozen=True)
class Damage:
    """A part of a file that cannot be read."""

    path: Path
    position: int
    """Offset in the file, bytes."""
    reason: str

    def __str__(self) -> str:
        where = f"byte {self.position}: "
        return f"{self.path}: {where}{self.reason.removeprefix(where)}"


OnDamage = Callable[[Damage], None]
"""Called for each part of a file that cannot be read, in the reading thread."""


class MessageQuery(NamedTuple):
    """Which messages to read; None: no limit.

    Attributes:
        names: of topics.
        start_ns, end_ns: first and last stamp.
        on_damage: called for parts that cannot be read; None: they are an error.
    """

    names: frozenset[str] | None
    start_ns: int | None
    end_ns: int | None
    on_damage: OnDamage | None

    @classmethod
    def of(
        cls,
        topics: Collection[str] | None,
        start_ns: int | None,
        end_ns: int | None,
        on_damage: OnDamage | None,
    ) -> Self:
        """Return the query of these arguments."""
        names = None if topics is None else frozenset(topics)
        return cls(names, start_ns, end_ns, on_damage)


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
    remarks: tuple[str, ...] = ()
    """What is unusual, but no damage: a definition that cannot be read."""
    profile: str = ""
    """Profile of the file's header, such as ``ros2``."""
    size: int
    """Total size of the files, bytes."""
    start_ns: int
    """Stamp of the first message; 0 without messages."""
    end_ns: int
    """Stamp of the last message; 0 without messages."""

    @property
    def losses(self) -> tuple[str, ...]:
        """The problems by which messages are lost: a missing index loses none."""
        return self.problems

    @property
    def files(self) -> tuple[Path, ...]:
        """The files with messages."""
        return (self.path,)

    @property
    @abstractmethod
    def compression(self) -> Mapping[str, int]:
        """Number of chunks (or files, or messages) by kind: ``none``, ``zstd``, …"""

    def attachments(self) -> Sequence[BagAttachment]:
        """Return the files inside; may scan the records once."""
        return ()

    def metadata_records(self) -> Sequence[MetadataRecord]:
        """Return the metadata records; may scan the records once."""
        return ()

    @abstractmethod
    def counts(self) -> Mapping[BagTopic, int]:
        """Number of messages by topic; may scan the whole file."""

    @abstractmethod
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
        return self.read(MessageQuery.of(topics, start_ns, end_ns, on_damage))

    def recorded_messages(
        self,
        topics: Collection[str] | None = None,
        *,
        start_ns: int | None = None,
        end_ns: int | None = None,
        on_damage: OnDamage | None = None,
        as_cdr: bool = False,
    ) -> Iterator[RecordedMessage]:
        """Iterate as :meth:`messages` does, over complete messages.

        Args:
            as_cdr: convert messages of ROS 1; otherwise the topics of the messages are
                those of the reader as :attr:`BagTopic.as_recorded`.
        """
        query = MessageQuery.of(topics, start_ns, end_ns, on_damage)
        return self.read_recorded(query, as_cdr=as_cdr)

    @abstractmethod
    def read(self, query: MessageQuery) -> Iterator[BagMessage]:
        """Iterate over the chosen messages; see :meth:`messages`."""

    def read_recorded(
        self, query: MessageQuery, *, as_cdr: bool
    ) -> Iterator[RecordedMessage]:
        """Iterate over the chosen messages; see :meth:`recorded_messages`."""
        for message in self.read(query):
            yield RecordedMessage(*message)

    @abstractmethod
    def close(self) -> None:
        """Close the files; a second call has no effect."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()
