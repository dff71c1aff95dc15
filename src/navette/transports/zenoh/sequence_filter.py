"""Duplicate and late samples dropped, missing ones counted, for each publisher."""

from collections.abc import Container

# Publishers remembered; those outside the graph are forgotten first.
_MAX_PUBLISHERS = 4096
# A number further away than this is not late or ahead of a gap: another program has
# used the publisher's gid with its own number, which must not block the publisher.
FAR_BEHIND = 10_000
FAR_AHEAD = 1_000_000

_NONE = -1


class SequenceFilter:
    """Decides for each sample of a subscription whether it is delivered. Not locked.

    Args:
        listed: gids of the publishers in the graph; changes meanwhile.
    """

    def __init__(self, listed: Container[bytes]) -> None:
        self._listed = listed
        #: Publisher → the sequence number that follows its newest sample.
        self._next: dict[bytes, int] = {}
        #: Publisher → the number that would follow a sample far from all others.
        self._outlier: dict[bytes, int] = {}

    def accept(self, gid: bytes, sequence: int) -> int | None:
        """Return how many samples are missing before this one; None: do not deliver."""
        expected = self._next.get(gid)
        if expected == sequence:
            self._next[gid] = sequence + 1
            return 0
        if expected is None:
            self._add(gid, sequence)
            return 0
        if not expected - FAR_BEHIND <= sequence < expected + FAR_AHEAD:
            return self._accept_outlier(gid, sequence)
        if sequence < expected:
            return None
        self._next[gid] = sequence + 1
        return sequence - expected

    def _add(self, gid: bytes, sequence: int) -> None:
        if len(self._next) >= _MAX_PUBLISHERS:
            unlisted = (each for each in self._next if each not in self._listed)
            oldest = next(unlisted, None) or next(iter(self._next))
            del self._next[oldest]
            self._outlier.pop(oldest, None)
        self._next[gid] = sequence + 1

    def _accept_outlier(self, gid: bytes, sequence: int) -> int | None:
        """Deliver it; two in a row are of a publisher that restarted its numbering."""
        follower = self._outlier.get(gid, _NONE)
        if sequence == follower - 1:
            return None  # a duplicate
        if sequence == follower:
            del self._outlier[gid]
            self._next[gid] = sequence + 1
        else:
            self._outlier[gid] = sequence + 1
        return 0
