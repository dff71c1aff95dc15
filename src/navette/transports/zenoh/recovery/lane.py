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


class Room:
    """How many bytes several lanes may hold together."""

    __slots__ = ("_free",)

    def __init__(self, size: int = MOST_HELD_BYTES) -> None:
        self._free = size

    def take(self, size: int) -> bool:
        """Whether there was so much room; it is taken then."""
        fits = size <= self._free
        self._free -= size if fits else 0
        return fits

    def give_back(self, size: int) -> None:
        """So much is free again."""
        self._free += size


class Lane(Generic[T]):
    """Gives each sample once, by ascending numbers; holds back what comes too early.

    What is :meth:`missing` is either taken later or given up. It has no lock, thread
    or time of its own: its owner has.

    Args:
        is_expected: it will be told from where on something is owed; what comes before
            that is held. Else it starts with what comes first.
    """

    __slots__ = (
        "_begun",
        "_held",
        "_is_expected",
        "_newest",
        "_next",
        "_ready",
        "_room",
        "_stray",
    )

    def __init__(self, room: Room | None = None, *, is_expected: bool = False) -> None:
        self._room = room or Room()
        self._is_expected = is_expected
        # The number that may pass at once; never while something is held.
        self._ready = _NEVER
        self._next = _NEVER
        self._newest = _NEVER
        self._begun = False
        # What would follow one that was far from all others.
        self._stray = _NEVER
        self._held: dict[int, tuple[T, int]] = {}

    def passes(self, number: int) -> bool:
        """Whether it is the next one, with nothing else to do: the usual case."""
        if number != self._ready:
            return False
        self._ready = number + 1
        return True

    def start_after(self, number: int) -> list[T]:
        """Samples after ``number`` are owed: what is to be delivered now.

        One not above ``number`` is taken all the same while nothing was delivered: it
        was on its way when this was said. Nothing where it has started.
        """
        if self._next != _NEVER or number < 0:
            return []
        self._next = number + 1
        self.reach(number)
        return self.start()

    def start(self) -> list[T]:
        """Nobody will say from where on: what is to be delivered now."""
        self._is_expected = False
        if self._begun:
            return []
        held = [(each, *self._held[each]) for each in sorted(self._held)]
        self.drop()
        return [due for each in held for due in self.take(*each)]

    @property
    def is_held_up(self) -> bool:
        """Whether something waits for the start."""
        return bool(self._held) and self._next == _NEVER

    def reach(self, number: int) -> None:
        """The publisher has come to ``number``; nothing where it has not started."""
        self._settle()
        if self._next != _NEVER and number < self._next + FAR_AHEAD:
            self._newest = max(self._newest, number)

    def take(self, number: int, sample: T, size: int) -> list[T]:
        """A sample has come: what is to be delivered now, in order."""
        self._settle()
        if self._next == _NEVER and self._is_expected and number > 1:
            self._hold(number, sample, size)
            return []
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

    def drop(self) -> None:
        """Hold nothing any more."""
        for number in list(self._held):
            self._unhold(number)

    def _hold(self, number: int, sample: T, size: int) -> None:
        if number in self._held or len(self._held) >= MOST_HELD:
            return
        if self._room.take(size):
            self._held[number] = sample, size

    def _unhold(self, number: int) -> T:
        sample, size = self._held.pop(number)
        self._room.give_back(size)
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
