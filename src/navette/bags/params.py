"""Parameters of a recording."""

from dataclasses import dataclass

from navette.bags.mcap_file import COMPRESSIONS
from navette.bags.selection import TopicSelection
from navette.params import Params, param


@dataclass(frozen=True, kw_only=True)
class RecorderParams(Params):
    """Selection of topics, file splitting and flushing."""

    topics: tuple[str, ...] = param(
        (), "full names of topics to record; all if no topic, regex or type is given"
    )
    types: tuple[str, ...] = param((), "record topics of these types")
    regex: str = param("", "record topics whose full name matches this pattern")
    exclude: str = param(
        "", "do not record topics whose full name matches this pattern"
    )
    exclude_types: tuple[str, ...] = param((), "do not record topics of these types")
    images: bool = param(False, "record raw images too (each camera then renders)")
    hidden: bool = param(False, "record hidden topics too (/_…)")
    flush_period_s: float = param(
        0.25,
        "longest time before received messages are written to disk",
        at_least=0.01,
        at_most=10.0,
    )
    compression: str = param("zstd", "compression of the chunks", choices=COMPRESSIONS)
    max_bag_size_bytes: int = param(
        0, "size at which a new file is started; 0 for one file", at_least=0
    )
    max_bag_duration_s: float = param(
        0.0, "duration after which a new file is started; 0 for one file", at_least=0.0
    )
    snapshot_duration_s: float = param(
        0.0,
        "duration kept in memory and written on request; 0 writes continuously",
        at_least=0.0,
    )
    snapshot_bytes: int = param(
        512 * 2**20, "maximum memory of a snapshot", at_least=1024
    )
    paused: bool = param(False, "pause the recording")

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
        self.selection  # noqa: B018 - raises
