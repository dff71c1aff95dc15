"""Parameters of a recording."""

from dataclasses import dataclass

from navette.bags.selection import TopicSelection
from navette.params import Params, param


@dataclass(frozen=True, kw_only=True)
class RecorderParams(Params):
    """What is recorded, and how much a killed process may lose."""

    topics: tuple[str, ...] = param(
        (), "full names of topics to record; none (and no regex) is all"
    )
    regex: str = param("", "record topics whose full name matches this pattern")
    exclude: str = param("", "leave out topics whose full name matches this pattern")
    images: bool = param(False, "record raw images too (each camera then renders)")
    flush_period_s: float = param(
        0.25,
        "time after which what was recorded is safe on disk",
        unit="s",
        at_least=0.01,
        at_most=10.0,
    )

    @property
    def selection(self) -> TopicSelection:
        return TopicSelection(self.topics, self.regex, self.exclude, self.images)

    def check(self) -> None:
        """Patterns must compile."""
        self.selection  # noqa: B018 - raises
