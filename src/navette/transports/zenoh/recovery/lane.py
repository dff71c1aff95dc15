"""One publisher's samples on their way to one subscription, put in order."""

from typing import Generic, TypeVar

T = TypeVar("T")

# Held while something before them is missing. What does not fit is not lost: it counts
# as missing, and is asked for in its turn.
MOST_HELD = 4096
MOST_HELD_BYTES = 64 * 1024 * 1024

# Nothing is late or missing by as much: somebody has used the publisher's name with a
# number of his own, which must not shut it out. Two in a row: it counts anew.
FAR_BEHIND = 10_000
FAR_AHEAD = 1_000_000

_NEVER = -1


class Lane(Generic[T]):
    """Gives each sample once, by ascending numbers; holds back what comes too early.

    What is :meth:`missing` is either taken later or given up. It has no lock, thread
    or time of its own: its owner has.
    """

    __slots__ = ("_begun", "_bytes", "_held", "_newest", "_next", "_ready", "_stray")

    def __init__(self) -> None:
        # The number that may pass at once; never while something is held.
        self._ready = _NEVER
        self._next = _NEVER
        self._newest = _NEVER
        self._begun = False
        # What would follow one that was far from all others.
        self._stray = _NEVER
        self._held: dict[int, tuple[T, int]] = {}
        self._bytes = 0

    def passes(self, number: int) -> bool:
        """Whether it is the next one, with nothing else to do: the usual case."""
        if number != self._ready:
            return False
        self._ready = number + 1
        return True

    def start_after(self, number: int) -> None:
        """Samples after ``number`` are owed; where it has started: told of a newest.

        One not above ``number`` is taken all the same while nothing was delivered: it
        was on its way when this was said.
        """
        if self._next == _NEVER:
            self._next = number + 1
        self.reach(number)

    def reach(self, number: int) -> None:
        """The publisher has come to ``number``; nothing where it has not started."""
        self._settle()
        if self._next != _NEVER and number < self._next + FAR_AHEAD:
            self._newest = max(self._newest, number)

    def take(self, number: int, sample: T, size: int) -> list[T]:
        """A sample has come: what is to be delivered now, in order."""
        self._settle()
        if self._next == _NEVER or (number < self._next and not self._begun):
            self._next = number
        if not self._next - FAR_BEHIND <= number < self._next + FAR_AHEAD:
            return self._take_far(number, sample)
        if number < self._next or number in self._held:
            return []
        self._newest = max(self._newest, number)
        if number > self._next:
            self._hold(number, sample, size)
            self._ready = _NEVER if self._held else self._ready
            return []
        self._next = number + 1
        return [sample, *self._released()]

    @property
    def is_waiting(self) -> bool:
        """Whether something is missing."""
        self._settle()
        return _NEVER != self._next <= self._newest

    def missing(self) -> tuple[int, int] | None:
        """The first and the last number of the first gap."""
        if not self.is_waiting:
            return None
        return self._next, min(self._held) - 1 if self._held else self._newest

    def give_up(self, number: int) -> tuple[int, list[T]]:
        """Wait for nothing up to ``number``: how many are lost, what can go now."""
        self._settle()
        if self._next == _NEVER or number < self._next:
            return 0, []
        early = sorted(each for each in self._held if each <= number)
        lost = number - self._next + 1 - len(early)
        self._next = number + 1
        return lost, [*(self._unhold(each) for each in early), *self._released()]

    def give_up_all(self) -> tuple[int, list[T]]:
        """Wait for nothing that is missing by now."""
        return self.give_up(self._newest)

    def _take_far(self, number: int, sample: T) -> list[T]:
        if number == self._stray - 1:
            return []  # by another way
        if number != self._stray:
            self._stray = number + 1
            return [sample]
        self._stray = _NEVER
        held = [self._unhold(each) for each in sorted(self._held)]
        self._next, self._newest = number + 1, number
        return [*held, sample, *self._released()]

    def _hold(self, number: int, sample: T, size: int) -> None:
        if len(self._held) < MOST_HELD and self._bytes + size <= MOST_HELD_BYTES:
            self._held[number] = sample, size
            self._bytes += size

    def _unhold(self, number: int) -> T:
        sample, size = self._held.pop(number)
        self._bytes -= size
        return sample

    def _released(self) -> list[T]:
        """What is no longer held back; the lane is open again where nothing is."""
        self._begun = True
        released = []
        while self._next in self._held:
            released.append(self._unhold(self._next))
            self._next += 1
        self._ready = _NEVER if self._held else self._next
        return released

    def _settle(self) -> None:
        if self._ready != _NEVER:
            self._next = self._ready
