"""Open a recording of any format."""

from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import BinaryIO

import zstandard

from navette.bags.bag import BagReader
from navette.bags.db3_reader import MAGIC as DB3_MAGIC
from navette.bags.db3_reader import Db3Reader
from navette.bags.folder_reader import METADATA, FolderReader, Metadata, read_metadata
from navette.bags.mcap_reader import McapReader
from navette.bags.mcap_records import MAGIC as MCAP_MAGIC
from navette.bags.ros1_reader import Ros1Reader
from navette.errors import FileFormatError
from navette.files.untrusted.files import open_regular

SUFFIXES = (".mcap", ".bag", ".db3")
PACKED = ".zstd"
_MOST_RATIO = 1000
_FREE_BYTES = 64 << 20


def open_bag(path: Path | str) -> BagReader:
    """Open a ``.mcap``, ``.bag`` or ``.db3`` file, or a rosbag2 folder.

    The first bytes determine the format. A file without an index is scanned once;
    damaged parts are listed in ``problems``, intact parts can be read. ``subset`` is
    ``subset.mcap`` where only that exists: recordings get a suffix when written.

    Raises:
        FileFormatError: the path does not exist or is not a readable recording.
    """
    path = _with_suffix(Path(path))
    if path.is_dir():
        return _open_folder(path)
    return _open_file(path)


def _with_suffix(path: Path) -> Path:
    """Return the path, or the existing recording whose name lacks the suffix only."""
    if path.exists() or not path.name:
        return path
    named = (path.with_name(f"{path.name}{suffix}") for suffix in SUFFIXES)
    return next((each for each in named if each.is_file()), path)


def is_bag(path: Path) -> bool:
    """Whether a file or folder is a recording, by its name."""
    if path.is_dir():
        return (path / METADATA).is_file()
    name = path.name.removesuffix(PACKED).removesuffix(".active")
    return path.is_file() and name.endswith(SUFFIXES)


def holds_bag(path: Path) -> bool:
    """Whether a file is empty or a recording (by its first bytes) and replaceable."""
    with path.open("rb") as file:
        start = file.read(16)
    return not start or start.startswith((DB3_MAGIC, b"#ROS", MCAP_MAGIC))


def _open_file(path: Path) -> BagReader:
    with open_regular(path) as file:
        start = file.read(16)
    if not start:
        raise FileFormatError(path, "is empty")
    if start.startswith(DB3_MAGIC):
        return Db3Reader(path)
    if start.startswith(b"#ROS"):
        return Ros1Reader(path)
    if start.startswith(MCAP_MAGIC):
        return McapReader(path)
    if path.name.endswith(PACKED):
        return _open_packed(path)
    known: dict[str, Callable[[Path], BagReader]] = {
        ".db3": Db3Reader,
        ".bag": Ros1Reader,
        ".mcap": McapReader,
    }
    reader = known.get(path.suffix)
    if reader is not None:
        return reader(path)  # raises an error about the first bytes
    raise FileFormatError(
        path, "is not a recording; supported: .mcap, .bag, .db3 or a rosbag2 folder"
    )


def _open_packed(path: Path) -> BagReader:
    """Decompress a file that rosbag2 compressed as a whole to a temporary file."""
    with ExitStack() as stack:
        folder = Path(stack.enter_context(TemporaryDirectory(prefix="navette-bag-")))
        unpacked = folder / path.name.removesuffix(PACKED)
        try:
            with open_regular(path) as packed, unpacked.open("wb") as out:
                _unpack(path, packed, out)
        except (zstandard.ZstdError, OSError) as error:
            raise FileFormatError(path, f"cannot be decompressed: {error}") from error
        reader = stack.enter_context(_open_file(unpacked))
        return _Unpacked(path, reader, stack.pop_all())


def _unpack(path: Path, packed: BinaryIO, out: BinaryIO) -> None:
    """Decompress a recording; refuse other content and content that expands too far."""
    most = _FREE_BYTES + _MOST_RATIO * path.stat().st_size
    size = 0
    stream = zstandard.ZstdDecompressor().stream_reader(packed)
    while block := stream.read(1 << 20):
        if size == 0 and not block.startswith((DB3_MAGIC, b"#ROS", MCAP_MAGIC)):
            raise FileFormatError(path, "is not a compressed recording")
        size += len(block)
        if size > most:
            raise FileFormatError(
                path, f"expands more than {_MOST_RATIO} times; not a recording"
            )
        out.write(block)


class _Unpacked(FolderReader):
    """A decompressed file; the temporary copy is deleted with it."""

    def __init__(self, path: Path, reader: BagReader, stack: ExitStack) -> None:
        metadata = Metadata(reader.version, compression="zstd (file)")
        super().__init__(path, [reader], metadata)
        self.size = path.stat().st_size
        self._stack = stack

    @property
    def files(self) -> tuple[Path, ...]:
        return (self.path,)

    def close(self) -> None:
        self._stack.close()


def _open_folder(folder: Path) -> BagReader:
    problems: list[str] = []
    try:
        metadata = read_metadata(folder)
    except FileFormatError as error:
        problems.append(str(error))
        metadata = Metadata()
    files = [each for each in folder.iterdir() if each.is_file() and is_bag(each)]
    names = metadata.files or tuple(sorted(each.name for each in files))
    if not names:
        has_metadata = (folder / METADATA).exists()
        reason = "; ".join(problems) or "metadata.yaml lists no files"
        raise FileFormatError(
            folder,
            f"is not a recording: {reason}"
            if has_metadata
            else "is not a recording: it has neither metadata.yaml nor bag files",
        )
    with ExitStack() as stack:
        readers: list[BagReader] = []
        for name in names:
            try:
                readers.append(stack.enter_context(_open_file(folder / name)))
            except FileFormatError as error:
                problems.append(str(error))
        if not readers:
            raise FileFormatError(folder, f"no file can be read: {'; '.join(problems)}")
        stack.pop_all()
        return FolderReader(folder, readers, metadata, problems)
