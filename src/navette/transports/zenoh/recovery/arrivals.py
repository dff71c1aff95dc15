"""What comes to a subscription: each publisher's samples once, and in its order."""

import threading
from collections.abc import Callable

import zenoh

from navette.transports.base import Item, Sink
from navette.transports.expiring import Expiring
from navette.transports.zenoh.matches import Matches
from navette.transports.zenoh.recovery.answer import Recovered
from navette.transports.zenoh.recovery.lane import Lane, Room
from navette.transports.zenoh.recovery.wants import Wants

# Publishers remembered at most; those that are not listed in the graph come to it.
_MOST_PUBLISHERS = 4096


class Arrivals:
    """Passes samples on; where some are missing, asks for them and holds the rest.

    Safe to use from several threads; the sink is called under a lock.

    Args:
        key: of the topic's samples.
        lost: told how many samples will not come.
        checked: whose a sample is, and the item to deliver; None: nobody's.
        wants: where to ask; None: what is missing is lost at once (best effort).
    """

    __slots__ = (
        "_checked",
        "_is_latched",
        "_is_open",
        "_lanes",
        "_lock",
        "_lost",
        "_room",
        "_sink",
        "_wants",
        "key",
        "matches",
    )

    def __init__(
        self,
        matches: Matches,
        key: str,
        sink: Sink,
        *,
        lost: Callable[[int], None],
        checked: Callable[[zenoh.Sample | Recovered], tuple[bytes, Item] | None],
        wants: Wants | None,
    ) -> None:
        self.matches = matches
        self.key = key
        self._sink = sink
        self._lost = lost
        self._checked = checked
        self._wants = wants
        self._is_latched = matches.endpoint.qos.is_latched
        self._is_open = True
        self._lanes: dict[bytes, Lane[Item]] = {}
        self._room = Room()
        self._lock = threading.Lock()

    def take(self, gid: bytes, item: Item) -> None:
        """A sample of that publisher has come."""
        with self._lock:
            lane = self._lanes.get(gid)
            if lane is not None and lane.passes(item[3]):
                self._sink(item)
                return
            lane = lane or self._lane(gid)
            lost = self._deliver(gid, lane, lane.take(item[3], item, _size(item)))
            is_waiting, is_held_up = lane.is_waiting, lane.is_held_up
        self._follow_up(gid, lost, is_waiting=is_waiting)
        if is_held_up and self._wants is not None:
            self._wants.starts.await_letter(self, gid)

    def close(self) -> None:
        """Deliver nothing more."""
        with self._lock:
            self._is_open = False
            self._lanes.clear()

    # -- for the recovery --------------------------------------------------------

    def start_after(self, gid: bytes, number: int) -> None:
        """What comes after that number is owed to it; any thread."""
        # What a latched publisher has kept comes first; it begins with that.
        if not self._is_latched:
            self._change(gid, lambda lane: lane.start_after(number), new=True)

    def start(self, gid: bytes) -> None:
        """Nobody will say from where on; any thread."""
        self._change(gid, lambda lane: lane.start() if lane.is_held_up else [])

    def is_held_up(self, gid: bytes) -> bool:
        """Whether something waits to be told from where on it is owed something."""
        lane = self._lanes.get(gid)
        return lane is not None and lane.is_held_up

    def reach(self, gid: bytes, number: int) -> None:
        """The publisher has come to that number; any thread."""

        def reached(lane: Lane[Item]) -> list[Item]:
            lane.reach(number)
            return []

        self._change(gid, reached)

    def missing(self, gid: bytes) -> tuple[int, int] | None:
        """First and last number of the first gap."""
        with self._lock:
            lane = self._lanes.get(gid)
            return None if lane is None else lane.missing()

    def recover(self, gid: bytes, sample: Recovered) -> None:
        """A sample that was asked for.

        Answers are in order: what was asked for and is before it is not there any more.
        """
        found = self._checked(sample)
        gap = self.missing(gid)
        if found is None or found[0] != gid or gap is None:
            return
        number = found[1][3]
        if gap[0] <= number <= gap[1]:  # else it has come meanwhile
            self.give_up(gid, number - 1)
            self.take(*found)

    def give_up(self, gid: bytes, number: int | None) -> None:
        """What is missing up to that number (None: all) is lost."""
        with self._lock:
            lane = self._lanes.get(gid)
            if lane is None:
                return
            given_up = lane.give_up_all() if number is None else lane.give_up(number)
            lost, due = given_up
            for item in due:
                self._sink(item)
        if lost:
            self._lost(lost)

    # -- inside ------------------------------------------------------------------

    def _change(
        self,
        gid: bytes,
        change: Callable[[Lane[Item]], list[Item]],
        *,
        new: bool = False,
    ) -> None:
        """Do something to a lane, deliver what is due then, ask for what is missing."""
        with self._lock:
            lane = self._lane(gid) if new else self._lanes.get(gid)
            if lane is None:
                return
            lost = self._deliver(gid, lane, change(lane))
            is_waiting = lane.is_waiting
        self._follow_up(gid, lost, is_waiting=is_waiting)

    def _lane(self, gid: bytes) -> Lane[Item]:
        lane = self._lanes.get(gid)
        if lane is None:
            lane = Lane(self._room, is_expected=self._expects_letter(gid))
            if self._is_open:
                if len(self._lanes) >= _MOST_PUBLISHERS:
                    self._forget_one()
                self._lanes[gid] = lane
        return lane

    def _expects_letter(self, gid: bytes) -> bool:
        """Whether its publisher is, or may be, going to say from where on."""
        if self._wants is None or self._is_latched:
            return False
        return self._wants.starts.expects(self.matches.sessions.get(gid))

    def _forget_one(self) -> None:
        """The oldest, but first those that the graph does not list (any more)."""
        listed = self.matches.by_gid
        strangers = (gid for gid in self._lanes if gid not in listed)
        gid = next(strangers, None) or next(iter(self._lanes))
        self._lanes.pop(gid).drop()

    def _deliver(self, gid: bytes, lane: Lane[Item], due: list[Item]) -> int:
        """Pass on what is due; how many are lost, as there is nobody to ask."""
        lost = 0
        if lane.is_waiting and (self._wants is None or not self._wants.can_ask(gid)):
            lost, more = lane.give_up_all()
            due = [*due, *more]
        if self._is_open:
            for item in due:
                self._sink(item)
        return lost

    def _follow_up(self, gid: bytes, lost: int, *, is_waiting: bool) -> None:
        if lost:
            self._lost(lost)
        if is_waiting and self._wants is not None:
            self._wants.want(self, gid)


def _size(item: Item) -> int:
    message = item[0]
    return len((message.message if message.__class__ is Expiring else message).data)
