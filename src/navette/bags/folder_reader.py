"""Read rosbag2 folders: ``metadata.yaml`` and one or more files."""

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from heapq import heappop, heappush
from pathlib import Path
from typing import Any, TypeVar

import yaml

from navette.bags.bag import (
    BagAttachment,
    BagMessage,
    BagReader,
    BagTopic,
    MessageQuery,
    MetadataRecord,
    RecordedMessage,
)
from navette.bags.qos import parse_qos
from navette.errors import FileFormatError
from navette.files.untrusted.budget import METADATA as METADATA_BUDGET
from navette.files.untrusted.files import open_regular
from navette.files.untrusted.yaml_input import (
    BoundedLoader,
    line_of,
    load_yaml,
    problem_of,
)

METADATA = "metadata.yaml"
_AnyMessage = TypeVar("_AnyMessage", BagMessage, RecordedMessage)


class _MetadataLoader(BoundedLoader):
    BUDGET = METADATA_BUDGET


@dataclass(frozen=True)
class Metadata:
    """Content of ``metadata.yaml``; missing entries are empty."""

    version: str = ""
    files: tuple[str, ...] = ()
    compression: str = ""
    """``zstd (file)``, ``zstd (message)`` or "" for none."""
    counts: Mapping[tuple[str, str], int] | None = None
    """Messages by topic and type."""
    qos: Mapping[tuple[str, str], Any] | None = None
    hashes: Mapping[tuple[str, str], str] | None = None


def read_metadata(folder: Path) -> Metadata:
    """Read the metadata of a folder.

    Raises:
        FileFormatError: missing, or not rosbag2 metadata.
    """
    path = folder / METADATA
    try:
        with open_regular(path) as file:
            data = file.read(METADATA_BUDGET.octets + 1)
        found = load_yaml(data.decode("utf-8", "replace"), _MetadataLoader)
    except OSError as error:
        raise FileFormatError(path, f"cannot be read: {error.strerror}") from error
    except yaml.YAMLError as error:
        reason = f"is not YAML: {problem_of(error)}"
        raise FileFormatError(path, reason, line_of(error)) from error
    try:
        return _parse(found["rosbag2_bagfile_information"])
    except (KeyError, TypeError, AttributeError, ValueError) as error:
        raise FileFormatError(path, f"is not rosbag2 metadata: {error!r}") from error


def _parse(found: Mapping[str, Any]) -> Metadata:
    topics: dict[tuple[str, str], tuple[Any, int]] = {}
    for each in found.get("topics_with_message_count") or ():
        topic = each["topic_metadata"]
        key = _word(topic["name"]), _word(topic["type"])
        topics[key] = topic, int(each["message_count"])
    kind = _word(found.get("compression_format"))
    mode = _word(found.get("compression_mode")).lower()
    names = [_word(path) for path in found["relative_file_paths"]]
    return Metadata(
        version=_word(found["version"]),
        files=tuple(Path(name).name for name in names if Path(name).name),
        compression=f"{kind} ({mode})" if kind and mode not in ("", "none") else "",
        counts={key: count for key, (_, count) in topics.items()},
        qos={key: t.get("offered_qos_profiles", "") for key, (t, _) in topics.items()},
        hashes={
            key: _word(t.get("type_description_hash")) for key, (t, _) in topics.items()
        },
    )


def _word(found: object) -> str:
    """Convert text or a number to text; nested lists could print endlessly."""
    if found is None:
        return ""
    if isinstance(found, str | int):
        return str(found)
    raise TypeError(f"{type(found).__name__} instead of text")


class FolderReader(BagReader):
    """Several files as one recording.

    Args:
        readers: open readers of the files; closed with this one.
    """

    def __init__(
        self,
        path: Path,
        readers: Sequence[BagReader],
        metadata: Metadata,
        problems: Sequence[str] = (),
    ) -> None:
        self.path = path
        #: The files ordered by their first stamps.
        self.readers = sorted(readers, key=lambda reader: reader.start_ns)
        self.start_ns = min((r.start_ns for r in readers if r.end_ns), default=0)
        self.end_ns = max(reader.end_ns for reader in readers)
        self._metadata = metadata
        self.storage = readers[0].storage
        self.size = sum(reader.size for reader in readers)
        self.version = metadata.version
        names = {reader: reader.path.name for reader in readers}
        self._own_problems = tuple(problems)
        self.problems = (
            *problems,
            *(f"{names[r]}: {each}" for r in readers for each in r.problems),
        )
        self.remarks = tuple(
            f"{names[r]}: {each}" for r in readers for each in r.remarks
        )
        profiles = {reader.profile for reader in readers}
        self.profile = profiles.pop() if len(profiles) == 1 else ""
        self._topic_of = {
            topic: self._completed(topic) for r in readers for topic in r.topics
        }
        self.topics = tuple(dict.fromkeys(self._topic_of.values()))

    @property
    def losses(self) -> tuple[str, ...]:
        parts = (f"{r.path.name}: {each}" for r in self.readers for each in r.losses)
        return (*self._own_problems, *parts)

    def _completed(self, topic: BagTopic) -> BagTopic:
        """Complete a topic with the metadata and the types of other files."""
        if not topic.qos and self._metadata.qos:
            qos = self._metadata.qos.get((topic.name, topic.type_name))
            topic = replace(topic, qos=parse_qos(qos))
        if not topic.type_hash and self._metadata.hashes:
            hash_ = self._metadata.hashes.get((topic.name, topic.type_name), "")
            topic = replace(topic, type_hash=hash_)
        for reader in self.readers:
            if topic.definition:
                break
            for other in reader.topics:
                if other.type_name == topic.type_name and other.definition:
                    topic = replace(topic, definition=other.definition)
        return topic

    def topic_of(self, topic: BagTopic) -> BagTopic:
        return self._topic_of[topic]

    @property
    def files(self) -> tuple[Path, ...]:
        return tuple(path for reader in self.readers for path in reader.files)

    @property
    def compression(self) -> Mapping[str, int]:
        if self._metadata.compression:
            return {self._metadata.compression: len(self.readers)}
        found: Counter[str] = Counter()
        for reader in self.readers:
            found.update(reader.compression)
        return found

    def attachments(self) -> Sequence[BagAttachment]:
        return [each for reader in self.readers for each in reader.attachments()]

    def metadata_records(self) -> Sequence[MetadataRecord]:
        return [each for reader in self.readers for each in reader.metadata_records()]

    def counts(self) -> Mapping[BagTopic, int]:
        known = self._metadata.counts
        names = {(topic.name, topic.type_name) for topic in self.topics}
        if known and not self.problems and len(names) == len(self.topics):
            return {t: known.get((t.name, t.type_name), 0) for t in self.topics}
        found = Counter(dict.fromkeys(self.topics, 0))
        for reader in self.readers:
            for topic, count in reader.counts().items():
                found[self._topic_of[topic]] += count
        return found

    def stamps(self) -> Iterator[tuple[BagTopic, int]]:
        for reader in self.readers:
            for topic, stamp in reader.stamps():
                yield self._topic_of[topic], stamp

    def read(self, query: MessageQuery) -> Iterator[BagMessage]:
        for message in self._merged(lambda reader: reader.read(query), query.start_ns):
            yield message._replace(topic=self._topic_of[message.topic])

    def read_recorded(
        self, query: MessageQuery, *, as_cdr: bool
    ) -> Iterator[RecordedMessage]:
        def opened(reader: BagReader) -> Iterator[RecordedMessage]:
            return reader.read_recorded(query, as_cdr=as_cdr)

        topic_of = self._topic_of
        if not as_cdr:
            topic_of = {k.as_recorded: t.as_recorded for k, t in topic_of.items()}
        for message in self._merged(opened, query.start_ns):
            yield message._replace(topic=topic_of[message.topic])

    def _merged(
        self, opened: Callable[[BagReader], Iterator[_AnyMessage]], start_ns: int | None
    ) -> Iterator[_AnyMessage]:
        waiting = [
            reader
            for reader in reversed(self.readers)
            if start_ns is None or reader.end_ns >= start_ns
        ]
        heap: list[tuple[int, int, _AnyMessage, Iterator[_AnyMessage]]] = []
        order = 0
        while heap or waiting:
            # A file is opened when its first stamp is reached.
            while waiting and (not heap or waiting[-1].start_ns <= heap[0][0]):
                rest = opened(waiting.pop())
                order += 1
                first = next(rest, None)
                if first is not None:
                    heappush(heap, (first.stamp_ns, order, first, rest))
            if heap:
                _, place, message, rest = heappop(heap)
                yield message
                following = next(rest, None)
                if following is not None:
                    heappush(heap, (following.stamp_ns, place, following, rest))

    def close(self) -> None:
        for reader in self.readers:
            reader.close()
