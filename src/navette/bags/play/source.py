"""Interface of a playable recording: a part of an open bag's."""

from collections.abc import Collection, Iterator, Sequence
from typing import Protocol

from navette.bags.bag import BagMessage, BagTopic


class Source(Protocol):
    """Recorded messages by stamp; every open bag is a source."""

    @property
    def topics(self) -> Sequence[BagTopic]:
        """Recorded topics."""

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
        """Iterate over messages of topics (None: all) between two stamps, inclusive."""
