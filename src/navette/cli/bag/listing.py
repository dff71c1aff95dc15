"""List the recordings in a folder."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rich.text import Text

from navette.bags import open_bag
from navette.bags.opening import is_bag
from navette.cli.bag.tables import new_table, open_console, show_table
from navette.cli.bag.text import count_text, duration_text, size_text, stamp_text
from navette.errors import FileFormatError


@dataclass(frozen=True)
class BagListing:
    """Summary of a recording, or the problem that prevents reading it."""

    path: Path
    size: int = 0
    start_ns: int = 0
    end_ns: int = 0
    messages: int = 0
    topics: int = 0
    problem: str = ""

    def to_json(self) -> dict[str, Any]:
        return {
            "path": str(self.path),
            "size": self.size,
            "start_ns": self.start_ns,
            "end_ns": self.end_ns,
            "duration_s": (self.end_ns - self.start_ns) / 1e9,
            "messages": self.messages,
            "topics": self.topics,
            "problem": self.problem,
        }


def find(folder: Path, *, recursive: bool = False) -> list[BagListing]:
    """Return all recordings in a folder (or the folder itself), sorted by name.

    Raises:
        FileFormatError: the folder does not exist, or is another file.
    """
    if not folder.exists():
        raise FileFormatError(folder, "no such folder")
    if not folder.is_dir() and not is_bag(folder):
        raise FileFormatError(folder, "neither a folder nor a recording")
    return [_summary(path) for path in sorted(_bags(folder, recursive=recursive))]


def _bags(folder: Path, *, recursive: bool) -> Iterator[Path]:
    if is_bag(folder):
        yield folder
        return
    for path in folder.iterdir():
        if is_bag(path):
            yield path
        elif recursive and path.is_dir() and not path.is_symlink():
            yield from _bags(path, recursive=True)


def _summary(path: Path) -> BagListing:
    try:
        with open_bag(path) as reader:
            return BagListing(
                path,
                reader.size,
                reader.start_ns,
                reader.end_ns,
                sum(reader.counts().values()),
                len(reader.topics),
                "; ".join(reader.problems),
            )
    except FileFormatError as error:
        return BagListing(path, problem=error.reason)


def show_list(found: list[BagListing]) -> None:
    table = new_table("bag", "start", ">duration", ">size", ">messages", ">topics", "")
    for each in found:
        duration = (each.end_ns - each.start_ns) / 1e9
        table.add_row(
            Text(str(each.path), style="cyan"),
            stamp_text(each.start_ns).partition(" (")[0],
            duration_text(duration).partition(" (")[0],
            size_text(each.size),
            count_text(each.messages),
            str(each.topics),
            Text(each.problem, style="yellow"),
        )
    show_table(open_console(), table)
