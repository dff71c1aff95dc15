"""Which topics are streams: their next message comes soon, or costs much."""

from collections import defaultdict

_STREAM_MESSAGES = 3  # in two periods
_STREAM_BYTES = 500_000


class Traffic:
    """Counts the messages of each channel in two consecutive periods."""

    def __init__(self) -> None:
        #: Channels with many messages, or many bytes, in the last two periods.
        self.streams = frozenset[int]()
        self._last: dict[int, tuple[int, int]] = {}
        self._now = defaultdict[int, tuple[int, int]](lambda: (0, 0))

    def add(self, channel: int, octets: int) -> None:
        messages, total = self._now[channel]
        self._now[channel] = messages + 1, total + octets

    def end_period(self) -> None:
        self.streams = frozenset(
            channel
            for channel in self._now.keys() | self._last.keys()
            if self._is_stream(channel)
        )
        self._last = dict(self._now)
        self._now.clear()

    def _is_stream(self, channel: int) -> bool:
        counts = self._last.get(channel, (0, 0)), self._now.get(channel, (0, 0))
        messages, octets = (sum(each) for each in zip(*counts, strict=True))
        return messages >= _STREAM_MESSAGES or octets >= _STREAM_BYTES
