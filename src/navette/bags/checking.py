"""Check a recording for errors."""

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import Enum
from pathlib import Path

from navette.bags.bag import BagReader, BagTopic, Damage
from navette.bags.chunked_reader import ChunkedReader
from navette.bags.chunks import Chunk, Entry
from navette.bags.db3_reader import Db3Reader
from navette.bags.folder_reader import FolderReader
from navette.bags.message_types import Decoder
from navette.bags.opening import open_bag
from navette.errors import FileFormatError, NavetteError

_MOST = 20
OnBytes = Callable[[int], None]


class Severity(Enum):
    """Consequence of a finding for readers of the recording."""

    ERROR = "error"
    """Messages are lost, or a reader may refuse the file."""
    WARNING = "warning"
    """All messages are present, but something is unusual."""


@dataclass(frozen=True)
class Finding:
    severity: Severity
    text: str


@dataclass(frozen=True)
class CheckReport:
    """Findings, and the number of messages read."""

    path: Path
    findings: tuple[Finding, ...]
    messages: int

    @property
    def is_sound(self) -> bool:
        """Whether there are no errors."""
        return all(f.severity is not Severity.ERROR for f in self.findings)


class _Findings:
    """Collects findings; of many similar ones the first few and their number."""

    def __init__(self) -> None:
        self.found: list[Finding] = []
        self._more: Counter[str] = Counter()

    def error(self, kind: str, text: str) -> None:
        self._add(Severity.ERROR, kind, text)

    def warning(self, kind: str, text: str) -> None:
        self._add(Severity.WARNING, kind, text)

    def _add(self, severity: Severity, kind: str, text: str) -> None:
        # The same problem may be found a second time, then with the name of a file.
        if any(f": {known.text}".endswith(f": {text}") for known in self.found):
            return
        self._more[kind] += 1
        if self._more[kind] <= _MOST:
            self.found.append(Finding(severity, text))

    def finished(self) -> tuple[Finding, ...]:
        more = [
            Finding(Severity.WARNING, f"{count - _MOST} more of this kind: {kind}")
            for kind, count in self._more.items()
            if count > _MOST
        ]
        return (*self.found, *more)


def check_bag(
    path: Path | str, *, decode: bool = False, on_bytes: OnBytes | None = None
) -> CheckReport:
    """Read a whole recording and compare it with its index and statistics.

    Args:
        decode: also deserialize every message.
        on_bytes: called with the number of bytes read since the last call.
    """
    findings = _Findings()
    path = Path(path)
    try:
        reader = open_bag(path)
    except FileFormatError as error:
        return CheckReport(path, (Finding(Severity.ERROR, error.reason),), 0)
    with reader:
        for problem in reader.problems:
            findings.error("problem", problem)
        counted = _check(reader, findings, on_bytes or _ignore)
        for remark in reader.remarks:
            findings.warning("remark", remark)
        _check_attachments(reader, findings)
        for text in out_of_order(reader):
            findings.warning("order", text)
        _check_counts(reader, counted, findings)
        if decode:
            _check_messages(reader, findings)
    return CheckReport(path, findings.finished(), sum(counted.values()))


def _ignore(count: int) -> None:
    """Ignore the progress."""


def _check(
    reader: BagReader, findings: _Findings, on_bytes: OnBytes
) -> Counter[BagTopic]:
    if isinstance(reader, FolderReader):
        counted: Counter[BagTopic] = Counter()
        for each in reader.readers:
            found = _check(each, findings, on_bytes)
            for topic, count in found.items():
                counted[reader.topic_of(topic)] += count
        return counted
    if isinstance(reader, ChunkedReader):
        return _check_chunks(reader, findings, on_bytes)
    if isinstance(reader, Db3Reader):
        for problem in reader.integrity():
            findings.error("database", f"{reader.path.name}: {problem}")
    return _count(reader, findings)


def _check_attachments(reader: BagReader, findings: _Findings) -> None:
    try:
        for attachment in reader.attachments():
            try:
                for _ in attachment.blocks():
                    pass
            except FileFormatError as error:
                findings.error("attachment", error.reason)
        reader.metadata_records()
    except FileFormatError as error:
        findings.error("attachment or metadata", error.reason)


def _count(reader: BagReader, findings: _Findings) -> Counter[BagTopic]:
    def damaged(damage: Damage) -> None:
        findings.error("data", f"{damage.path.name}: {damage.reason}")

    return Counter(m.topic for m in reader.messages(on_damage=damaged))


def _check_counts(
    reader: BagReader, counted: Counter[BagTopic], findings: _Findings
) -> None:
    for topic, stated in reader.counts().items():
        if stated != counted[topic]:
            findings.error(
                "counts",
                f"{topic.name}: {_messages(counted[topic])}, "
                f"the statistics state {stated}",
            )


def _check_chunks(
    reader: ChunkedReader, findings: _Findings, on_bytes: OnBytes
) -> Counter[BagTopic]:
    counted: Counter[BagTopic] = Counter()
    if not reader.index.is_scanned:
        _check_index(reader, findings)
    for chunk in reader.chunks:
        try:
            entries = reader.entries(chunk)
        except FileFormatError as error:
            findings.error("chunk", error.reason)
            continue
        _check_chunk(reader, chunk, entries, findings)
        for entry in entries:
            topic = reader.topic_of(entry.channel)
            if topic is not None:
                counted[topic] += 1
        on_bytes(chunk.length)
    return counted


def _check_chunk(
    reader: ChunkedReader, chunk: Chunk, entries: list[Entry], findings: _Findings
) -> None:
    where = f"byte {chunk.position}: chunk"
    unknown = {e.channel for e in entries if reader.topic_of(e.channel) is None}
    for channel in sorted(unknown):
        findings.error("channel", f"{where}: messages of undefined channel {channel}")
    if entries:
        first = min(entry.stamp_ns for entry in entries)
        last = max(entry.stamp_ns for entry in entries)
        if (first, last) != (chunk.start_ns, chunk.end_ns):
            findings.error(
                "times",
                f"{where}: stamps {first}…{last}, but its header states "
                f"{chunk.start_ns}…{chunk.end_ns}",
            )
    try:
        indexed = reader.index_of(chunk)
    except FileFormatError as error:
        findings.error("index", error.reason)
        return
    if indexed is None:
        return
    there = Counter((entry.channel, entry.stamp_ns) for entry in entries)
    stated = Counter((c, stamp) for c, stamps in indexed.items() for stamp in stamps)
    if there != stated:
        missing, wrong = (there - stated).total(), (stated - there).total()
        findings.error(
            "index",
            f"{where}: its index lacks {_messages(missing)}; wrong entries: {wrong}",
        )


def _check_index(reader: ChunkedReader, findings: _Findings) -> None:
    scanned = reader.scanned()
    for problem in scanned.problems:
        findings.error("records", problem)
    named = {chunk.position: chunk for chunk in reader.chunks}
    there = {chunk.position: chunk for chunk in scanned.chunks}
    for position in sorted(there.keys() - named.keys()):
        findings.error("index", f"byte {position}: the index lacks this chunk")
    for position in sorted(named.keys() & there.keys()):
        if _span(named[position]) != _span(there[position]):
            findings.error(
                "times", f"byte {position}: chunk: header and index disagree"
            )
    for position in sorted(named.keys() - there.keys()):
        findings.error(
            "index", f"byte {position}: the index lists a chunk that does not exist"
        )


def _span(chunk: Chunk) -> tuple[int, int, int]:
    return chunk.length, chunk.start_ns, chunk.end_ns


def _check_messages(reader: BagReader, findings: _Findings) -> None:
    """Decode all messages; only a recorded definition makes a failure an error."""
    decoders: dict[BagTopic, Decoder | None] = {}
    for message in reader.messages(on_damage=lambda damage: None):
        topic = message.topic
        try:
            if topic not in decoders:
                decoders[topic] = None
                decoders[topic] = Decoder(topic)
        except NavetteError as error:
            kind = f"{topic.name} not decoded"
            findings.warning(kind, f"{topic.name}: not decoded: {error}")
        decoder = decoders[topic]
        if decoder is None:
            continue
        try:
            decoder(message.data)
        except NavetteError as error:
            add = findings.error if topic.definition else findings.warning
            text = f"{topic.name} at {message.stamp_ns} ns: {error}"
            add(f"{topic.name} unreadable", text)


def out_of_order(reader: BagReader) -> Iterator[str]:
    """Find topics whose stamps decrease in file order."""
    last: dict[BagTopic, int] = {}
    back: Counter[BagTopic] = Counter()
    for topic, stamp in reader.stamps():
        if stamp < last.get(topic, stamp):
            back[topic] += 1
        last[topic] = stamp
    for topic, count in back.items():
        yield f"{topic.name}: the stamps decrease {count} times in file order"


def _messages(count: int) -> str:
    return f"{count} message{'s' * (count != 1)}"
