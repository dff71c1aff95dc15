"""What can be played: a part of an open bag's face."""

from collections.abc import Collection, Iterator, Sequence
from typing import Protocol

from navette.bags.bag import BagMessage, BagTopic


class Source(Protocol):
    """Recorded messages in the order of their stamps; every open bag is one."""

    @property
    def topics(self) -> Sequence[BagTopic]:
        """What was recorded."""

    @property
    def start_ns(self) -> int:
        """Stamp of the first message."""

    @property
    def end_ns(self) -> int:
        """Stamp of the last message."""

    def messages(
        self,
        topics: Collection[str] | None = None,
        *,
        start_ns: int | None = None,
        end_ns: int | None = None,
    ) -> Iterator[BagMessage]:
        """The messages of these topics (None = all) between two stamps, included."""
