"""Read a folder of MCAP files, such as the official conformance set, and copy each.

``python tests/conformance/mcap_set.py FOLDER`` takes the folder
``tests/conformance/data`` of github.com/foxglove/mcap, or any other. Every file is read
by Navette and by the official library, and copied by ``filter``, ``convert``, ``cut``
and ``merge``; the copies are compared record by record with the original. A clone
without Git LFS has only pointers to the files: these are made from their names, and
must have the checksums of the pointers. Prints the counts, and each difference; the
exit code is 0 without one.
"""

import hashlib
import re
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

sys.path.insert(0, str(Path(__file__).parents[1]))

from mcap.exceptions import McapError
from mcap_variants import variant

from mcap_content import McapContent, mcap_content
from navette.bags import BagReader, open_bag
from navette.bags.editing import MessageFilter, copy, join
from navette.bags.writing import open_writer
from navette.errors import NavetteError

_LFS = b"version https://git-lfs"


def check(path: Path, folder: Path, counts: Counter[str]) -> Iterator[str]:
    """Yield what differs between a file, Navette's reading and its copies."""
    expected = mcap_content(path)
    counts["messages"] += len(expected.messages)
    counts["attachments"] += len(expected.attachments)
    counts["metadata records"] += len(expected.metadata)
    with open_bag(path) as reader:
        found = [
            (m.topic.name, m.sequence, m.stamp_ns, m.publish_ns, m.data)
            for m in reader.recorded_messages()
        ]
        stated = [(c[0], *rest) for c, *rest in expected.messages]
        if found != stated:
            yield f"read: {len(found)} messages instead of {len(stated)}"
        if len(reader.attachments()) != len(expected.attachments):
            yield f"read: {len(reader.attachments())} attachments"
    for name, times, copied in copies(path, folder):
        counts["copies"] += 1
        wanted = McapContent(
            expected.profile,
            expected.channels,
            expected.messages * times,
            expected.attachments * times,
            expected.metadata * times,
        )
        yield from (f"{name}: {each}" for each in differences(wanted, copied))


def copies(path: Path, folder: Path) -> Iterator[tuple[str, int, McapContent]]:
    """Yield the verb, how often the copy holds the file, and the copy's content."""
    target = folder / "copy.mcap"
    for name, compression, selected in (
        ("convert", "lz4", None),
        ("filter", "zstd", MessageFilter(exclude="^$")),
        ("cut", "none", MessageFilter(start_ns=0, end_ns=2**64 - 1)),
    ):
        with open_bag(path) as reader:
            write_copy(reader, target, compression, selected)
        yield name, 1, mcap_content(target)
    with join([path, path]) as reader:
        write_copy(reader, target, "zstd", None)
    yield "merge", 2, mcap_content(target)


def write_copy(
    reader: BagReader, target: Path, compression: str, selected: MessageFilter | None
) -> None:
    writer = open_writer(
        target, compression=compression, overwrite=True, profile=reader.profile
    )
    copy(reader, writer, selected)


def differences(expected: McapContent, found: McapContent) -> Iterator[str]:
    for name in ("profile", "channels", "attachments", "metadata"):
        if getattr(expected, name) != getattr(found, name):
            yield f"{name}: {getattr(found, name)!r}, not {getattr(expected, name)!r}"
    if Counter(expected.messages) != Counter(found.messages):
        yield f"messages: {len(found.messages)} of {len(expected.messages)}, or others"


def _content(path: Path, folder: Path, counts: Counter[str]) -> Path:
    """Return a file, made from its name if there is only a pointer of Git LFS."""
    data = path.read_bytes()
    if not data.startswith(_LFS):
        return path
    made = variant(path.stem)
    (checksum,) = re.findall(rb"sha256:(\w+)", data)
    if hashlib.sha256(made).hexdigest() != checksum.decode():
        raise LookupError("the file's content is in Git LFS, and cannot be made")
    counts["files made with the stated checksum"] += 1
    (folder / path.name).write_bytes(made)
    return folder / path.name


def run(folder: Path) -> tuple[Counter[str], list[str]]:
    """Check every file below a folder; return the counts and the differences."""
    counts: Counter[str] = Counter()
    faults: list[str] = []
    with TemporaryDirectory() as temporary:
        for path in sorted(folder.rglob("*.mcap")):
            try:
                file = _content(path, Path(temporary), counts)
                found = list(check(file, Path(temporary), counts))
            except (NavetteError, McapError, LookupError) as error:
                found = [f"{type(error).__name__}: {error}"]
            counts["files"] += 1
            counts["files without a difference"] += not found
            faults += [f"{path.relative_to(folder)}: {each}" for each in found]
    return counts, faults


def main() -> None:
    counts, faults = run(Path(sys.argv[1]))
    for fault in faults:
        sys.stdout.write(f"{fault}\n")
    for name, count in counts.items():
        sys.stdout.write(f"{count} {name}\n")
    sys.exit(bool(faults) or not counts["files"])


if __name__ == "__main__":
    main()
