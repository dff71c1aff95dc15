"""Playback logic: the next message and its time. No node, no clock, no thread.

The caller passes the time with every call (``now_ns``, integer nanoseconds of any
clock), reads the time of the next call from :meth:`Player.due_ns`, and takes one
message at a time. The same calls produce the same messages with any clock.
"""

from dataclasses import dataclass
from enum import Enum

from navette.bags.bag import BagMessage, BagTopic
from navette.bags.play.feed import DirectFeed, Feed, MakeFeed
from navette.bags.play.latched import latched_before, recent_before
from navette.bags.play.options import PlayOptions
from navette.bags.play.playhead import Playhead
from navette.bags.play.source import Source
from navette.errors import InvalidValueError

LAST_PLAYED_NS = 2**31 * 1_000_000_000 - 1
"""Last time that a message of ROS 2 can hold: January 2038."""
# Minimum period of a looped recording with a single stamp.
_SHORTEST_PASS_NS = 10_000_000
# After a longer pause (a suspended process) playback does not catch up.
_MAX_LATE_NS = 1_000_000_000


class PlayState(Enum):
    PLAYING = "playing"
    PAUSED = "paused"
    ENDED = "ended"


@dataclass(frozen=True)
class Jump:
    """A change of position by a start, a loop or a seek."""

    to_ns: int
    latched: tuple[BagMessage, ...]
    """Latched messages at that position, oldest first."""
    recent: tuple[BagMessage, ...]
    """While paused: the last messages of the other topics, oldest first.

    A view shows that moment, although nothing is played.
    """


class Player:
    """Returns the messages of a bag one by one when they are due.

    Args:
        source: an open bag.
        make_feed: creates the message feed.

    Raises:
        UnknownNameError, InvalidValueError: no recorded topic matches the options.
    """

    def __init__(
        self,
        source: Source,
        options: PlayOptions,
        *,
        make_feed: MakeFeed = DirectFeed,
    ) -> None:
        self.options = options
        self._source = source
        self._make_feed = make_feed
        self.names = options.choose(topic.name for topic in source.topics)
        chosen = frozenset(self.names)
        self.topics = tuple(t for t in source.topics if t.name in chosen)
        self.begin_ns, self.end_ns = _range(source, options)
        self._head = Playhead(options.rate)
        self._feed: Feed | None = None
        self._ended = False
        self.passes = 0
        """Number of passes started; 0 before :meth:`start`."""
        self._jump: Jump | None = None

    # -- state -----------------------------------------------------------------

    @property
    def state(self) -> PlayState:
        if self._ended:
            return PlayState.ENDED
        return PlayState.PLAYING if self._head.moves else PlayState.PAUSED

    @property
    def rate(self) -> float:
        return self._head.rate

    def position_ns(self, now_ns: int) -> int:
        return max(self.begin_ns, min(self.end_ns, self._head.at(now_ns)))

    def last_before(self, topic: BagTopic, now_ns: int) -> list[BagMessage]:
        """Return the last messages of a topic that is not latched, as after a seek."""
        if self._feed is None:
            return []
        place_ns = self.position_ns(now_ns)
        following = None if self._ended else self._feed.peek()
        if following is None or following.stamp_ns > place_ns:
            place_ns += 1  # the message at this place has been played
        return recent_before(self._source, (topic,), place_ns)

    def due_ns(self) -> int | None:
        """Time of the next :meth:`take`; None while nothing is due."""
        if self._feed is None or self._ended or not self._head.moves:
            return None
        message = self._feed.peek()
        place_ns = self._pass_end_ns if message is None else message.stamp_ns
        return self._head.due_ns(place_ns)

    # -- playing ---------------------------------------------------------------

    def start(self, now_ns: int) -> None:
        moves = not self.options.paused
        self._go_to(now_ns, self.begin_ns, moves=moves)
        self.passes += 1
        self._ended = False
        self._head.moves = moves

    def take(self, now_ns: int) -> BagMessage | None:
        """Return the next message if it is due.

        At the end the recording loops, with a :class:`Jump`, or playback ends.
        """
        due_ns = self.due_ns()
        if due_ns is None or due_ns > now_ns:
            return None
        assert self._feed is not None, "a message is due, so there is a feed"
        message = self._feed.pop()
        place_ns = self._pass_end_ns if message is None else message.stamp_ns
        if now_ns - due_ns > _MAX_LATE_NS:
            self._head.place(now_ns, place_ns)
        if message is None:
            self._end_pass(due_ns)
        return message

    def step(self, now_ns: int) -> BagMessage | None:
        """Pause, and return the next message at once; None at the end."""
        self.pause(now_ns)
        if self._feed is None or self._ended:
            return None
        message = self._feed.pop()
        if message is None:
            self._end_pass(now_ns)
            if self.state is PlayState.ENDED:
                return None
            message = self._feed.pop()
        if message is not None:
            self._head.place(now_ns, message.stamp_ns)
        return message

    def pause(self, now_ns: int) -> None:
        self._head.set_moving(now_ns, moves=False)

    def resume(self, now_ns: int) -> None:
        self._head.set_moving(now_ns, moves=True)

    def set_rate(self, now_ns: int, rate: float) -> None:
        """Play at ``rate`` times real time.

        Raises:
            InvalidValueError: the rate is out of range.
        """
        self._head.set_rate(now_ns, rate)

    def seek(self, now_ns: int, bag_ns: int) -> int:
        """Seek to the nearest position that is played; return it."""
        place_ns = max(self.begin_ns, min(self.end_ns, bag_ns))
        self._go_to(now_ns, place_ns, moves=self._head.moves)
        self._ended = False
        return place_ns

    def pop_jump(self) -> Jump | None:
        """Return the last jump once, before the next message."""
        jump, self._jump = self._jump, None
        return jump

    def close(self) -> None:
        """Stop reading; a second call has no effect."""
        self._close_feed()

    # -- internals -------------------------------------------------------------

    @property
    def _pass_end_ns(self) -> int:
        return max(self.end_ns, self.begin_ns + _SHORTEST_PASS_NS)

    def _end_pass(self, now_ns: int) -> None:
        if not self.options.loop:
            self._head.place(now_ns, self.end_ns)
            self._ended = True
            return
        self._go_to(now_ns, self.begin_ns, moves=True)
        self.passes += 1

    def _go_to(self, now_ns: int, bag_ns: int, *, moves: bool) -> None:
        self._close_feed()
        self._head.place(now_ns, bag_ns)
        latched = latched_before(self._source, self.topics, bag_ns)
        recent = () if moves else recent_before(self._source, self.topics, bag_ns)
        self._jump = Jump(bag_ns, tuple(latched), tuple(recent))
        messages = self._source.messages(
            self.names, start_ns=bag_ns, end_ns=self.end_ns
        )
        self._feed = self._make_feed(messages)

    def _close_feed(self) -> None:
        if self._feed is not None:
            self._feed.close()
            self._feed = None


def _range(source: Source, options: PlayOptions) -> tuple[int, int]:
    """Return the first and last stamp to play."""
    length_s = (source.end_ns - source.start_ns) / 1e9
    begin_ns = source.start_ns + round(options.start_offset_s * 1e9)
    if begin_ns > LAST_PLAYED_NS:
        raise InvalidValueError(
            f"the first stamp to play is {begin_ns} ns; messages of ROS 2 hold times "
            "up to 2038"
        )
    if begin_ns > source.end_ns:
        raise InvalidValueError(
            f"start offset {options.start_offset_s:g} s: the bag has "
            f"only {length_s:.3f} s"
        )
    end_ns = min(source.end_ns, LAST_PLAYED_NS)
    if options.duration_s is not None:
        end_ns = min(end_ns, begin_ns + round(options.duration_s * 1e9))
    return begin_ns, max(begin_ns, end_ns)
