"""Parameters of a recording."""

from dataclasses import dataclass

from navette.bags.mcap_file import COMPRESSIONS
from navette.bags.selection import TopicSelection
from navette.params import Params, param


@dataclass(frozen=True, kw_only=True)
class RecorderParams(Params):
    """What is recorded, and how much a killed process may lose."""

    topics: tuple[str, ...] = param(
        (), "full names of topics to record; none (and no regex or type) is all"
    )
    types: tuple[str, ...] = param((), "record topics of these types")
    regex: str = param("", "record topics whose full name matches this pattern")
    exclude: str = param("", "leave out topics whose full name matches this pattern")
    exclude_types: tuple[str, ...] = param((), "leave out topics of these types")
    images: bool = param(False, "record raw images too (each camera then renders)")
    hidden: bool = param(False, "record hidden topics too (/_…)")
    flush_period_s: float = param(
        0.25,
        "time after which what was recorded is safe on disk",
        unit="s",
        at_least=0.01,
        at_most=10.0,
    )
    compression: str = param("zstd", "of the file's chunks", choices=COMPRESSIONS)
    max_bag_size_bytes: int = param(
        0, "size at which a new file begins; 0 for one file", unit="B", at_least=0
    )
    max_bag_duration_s: float = param(
        0.0, "length at which a new file begins; 0 for one file", unit="s", at_least=0.0
    )
    snapshot_duration_s: float = param(
        0.0,
        "keep this much in memory and write it only when asked; 0 to write always",
        unit="s",
        at_least=0.0,
    )
    snapshot_bytes: int = param(
        512 * 2**20, "most that a snapshot keeps in memory", unit="B", at_least=1024
    )
    paused: bool = param(False, "record nothing for the time being")

    @property
    def selection(self) -> TopicSelection:
        return TopicSelection(
            self.topics,
            self.regex,
            self.exclude,
            self.images,
            types=self.types,
            exclude_types=self.exclude_types,
            hidden=self.hidden,
        )

    def check(self) -> None:
        """Patterns must compile."""
        self.selection  # noqa: B018 - raises
