"""The node ``rosbag2_player``: says what a bag recorded, at the recorded times.

The bytes go out as they lie in the bag. Publishers offer what was offered when it was
recorded, so late joiners get latched topics; a start in the middle, a loop and a seek
first say what late joiners were to know at that place. With a clock rate it is the
source of ``/clock``: a jump is told there before anything else.

Services under the node's name, as rosbag2's player has them: pause, resume,
toggle_paused, is_paused, set_rate, get_rate, play_next, seek, stop.
"""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from navette.bags.bag import BagMessage, BagTopic
from navette.bags.play.feed import DirectFeed, PrefetchingFeed
from navette.bags.play.offers import joint_offer
from navette.bags.play.options import PlayOptions
from navette.bags.play.player import Player, PlayState
from navette.bags.play.services import SERVICES
from navette.bags.play.source import Source
from navette.bags.qos import OfferedQos
from navette.errors import NavetteError
from navette.msgs import get_interface, register_definition
from navette.msgs.rosgraph_msgs.msg import Clock as ClockMsg
from navette.runtime.context import Context
from navette.runtime.events import Call
from navette.runtime.node import Node
from navette.runtime.publisher import Publisher
from navette.runtime.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    QoSProfile,
    ReliabilityPolicy,
)
from navette.runtime.time import Duration, ns_to_stamp

CLOCK_TOPIC = "/clock"
_CLOCK_QOS = QoSProfile(depth=1)


@dataclass(frozen=True)
class PlayProgress:
    """How it goes: places in the recording in nanoseconds."""

    state: PlayState
    position_ns: int
    begin_ns: int
    end_ns: int
    rate: float
    passes: int
    published: int


class PlayerNode(Node):
    """Plays from :meth:`start` on; every method but :meth:`run_soon` on the loop.

    Args:
        source: an open bag; stays the caller's to close.
        remap: rules ``FROM:=TO`` for the topics.
        clock_rate_hz: tell the recording's time on ``/clock`` so often; a recorded
            ``/clock`` is then left out.
        on_end: called when the end is reached.
        on_change: called when state, rate or place changed other than by playing,
            with whether it was a jump.

    Raises:
        UnknownNameError, InvalidValueError: nothing of what was asked for is there.
    """

    def __init__(
        self,
        source: Source,
        options: PlayOptions | None = None,
        *,
        context: Context | None = None,
        node_name: str = "rosbag2_player",
        remap: Sequence[str] = (),
        clock_rate_hz: float | None = None,
        on_end: Callable[[], None] | None = None,
        on_change: Callable[[bool], None] | None = None,
    ) -> None:
        words = [word for rule in remap for word in ("-r", rule)]
        super().__init__(
            node_name,
            context=context,
            cli_args=["--ros-args", *words] if words else None,
        )
        self.on_end = on_end
        self.on_change = on_change
        self._clock_period_ns = clock_rate_hz and round(1e9 / clock_rate_hz)
        self._call: Call | None = None
        self._clock_call: Call | None = None
        self._published = 0
        lock_step = self.context.clock.is_virtual
        try:
            self.player = Player(
                _Without(source, CLOCK_TOPIC) if clock_rate_hz else source,
                options or PlayOptions(),
                DirectFeed if lock_step else PrefetchingFeed,
            )
        except NavetteError:
            super().destroy_node()
            raise
        self._clock_publisher = (
            self.create_publisher(ClockMsg, CLOCK_TOPIC, _CLOCK_QOS)
            if clock_rate_hz
            else None
        )
        self._outlets = {t: p for t in self.player.topics if (p := self._open_topic(t))}
        self._serve()

    # -- what it does ----------------------------------------------------------

    def start(self) -> None:
        """Begin to play (or stand at the beginning, if the options say so)."""
        self.player.start(self._now_ns())
        self._tick()
        self._changed(jumped=True)

    def progress(self) -> PlayProgress:
        """Where it is; may be asked from any thread."""
        player = self.player
        return PlayProgress(
            player.state,
            player.position_ns(self._now_ns()),
            player.begin_ns,
            player.end_ns,
            player.rate,
            player.passes,
            self._published,
        )

    def run_soon(self, action: Callable[[], object]) -> None:
        """Do something with the player between two callbacks; from any thread."""
        self.context.loop.call_soon_threadsafe(
            action, "player control", self.get_fully_qualified_name()
        )

    def pause(self) -> None:
        self.player.pause(self._now_ns())
        self._changed()

    def resume(self) -> None:
        """Go on; at the end, from the beginning."""
        if self.player.state is PlayState.ENDED:
            self.seek(self.player.begin_ns)
        self.player.resume(self._now_ns())
        self._changed()

    def toggle_paused(self) -> None:
        if self.player.state is PlayState.PLAYING:
            self.pause()
        else:
            self.resume()

    def step(self) -> bool:
        """Pause, and say the next message; False at the end."""
        message = self.player.step(self._now_ns())
        jumped = self._jump()
        if message is not None:
            self._say(message)
            self._publish_clock()
        elif self.player.state is PlayState.ENDED:
            self._end()
        self._changed(jumped=jumped)
        return message is not None

    def set_rate(self, rate: float) -> None:
        """Play ``rate`` times as fast as it was recorded.

        Raises:
            InvalidValueError: no rate.
        """
        self.player.set_rate(self._now_ns(), rate)
        self._changed()

    def seek(self, bag_ns: int) -> None:
        """Go to a place in the recording, or to the nearest that is played."""
        self.player.seek(self._now_ns(), bag_ns)
        self._changed(jumped=True)

    def seek_by(self, delta_ns: int) -> None:
        """Go forward or back."""
        self.seek(self.player.position_ns(self._now_ns()) + delta_ns)

    def control(self, *, play: bool, rate: float, seek_ns: int | None) -> None:
        """All at once: a place to go to (if any), a rate, and whether to play.

        Raises:
            InvalidValueError: no rate; nothing is changed.
        """
        player, now_ns = self.player, self._now_ns()
        player.set_rate(now_ns, rate)
        if seek_ns is None and play and player.state is PlayState.ENDED:
            seek_ns = player.begin_ns
        if seek_ns is not None:
            player.seek(now_ns, seek_ns)
        if play:
            player.resume(now_ns)
        else:
            player.pause(now_ns)
        self._changed(jumped=seek_ns is not None)

    def stop(self) -> None:
        """Pause, and end as if the end were reached."""
        self.pause()
        if self.on_end is not None:
            self.on_end()

    def destroy_node(self) -> None:
        for call in (self._call, self._clock_call):
            if call is not None:
                call.cancel()
        self.player.close()
        super().destroy_node()

    # -- in time ---------------------------------------------------------------

    def _now_ns(self) -> int:
        # Not the node's clock: that may follow the very /clock that is told here.
        return self.context.clock.now_ns

    def _changed(self, *, jumped: bool = False) -> None:
        """The next message is due at another time now."""
        self._jump()
        self._arm()
        if self.on_change is not None:
            self.on_change(jumped)

    def _arm(self) -> None:
        if self._call is not None:
            self._call.cancel()
        due_ns = self.player.due_ns()
        self._call = None if due_ns is None else self._at(due_ns, self._play)

    def _at(self, time_ns: int, function: Callable[[], None]) -> Call:
        name, loop = self.get_fully_qualified_name(), self.context.loop
        if time_ns <= self._now_ns():
            return loop.call_soon(function, "player", name)
        return loop.call_at(time_ns, function, "player", name)

    def _play(self) -> None:
        """One message an event: who listens in this process acts before the next."""
        message = self.player.take(self._now_ns())
        if message is not None:
            self._say(message)
        elif self._jump():
            self._changed(jumped=True)
            return
        elif self.player.state is PlayState.ENDED:
            self._publish_clock()
            self._end()
        self._arm()

    def _end(self) -> None:
        if self.on_change is not None:
            self.on_change(False)
        if self.on_end is not None:
            self.on_end()

    def _jump(self) -> bool:
        """After a start, a loop or a seek: time first, then what is known there."""
        jump = self.player.pop_jump()
        if jump is None:
            return False
        self._publish_clock()
        for message in jump.latched:
            self._say(message)
        return True

    def _say(self, message: BagMessage) -> None:
        publisher = self._outlets.get(message.topic)
        if publisher is not None:
            publisher.publish_encoded(message.data)
            self._published += 1

    def _tick(self) -> None:
        if self._clock_period_ns:
            self._publish_clock()
            due_ns = self._now_ns() + self._clock_period_ns
            self._clock_call = self._at(due_ns, self._tick)

    def _publish_clock(self) -> None:
        if self._clock_publisher is not None:
            position_ns = self.player.position_ns(self._now_ns())
            self._clock_publisher.publish(ClockMsg(clock=ns_to_stamp(position_ns)))

    # -- topics and services ---------------------------------------------------

    def _open_topic(self, topic: BagTopic) -> Publisher[Any] | None:
        """None, and a warning, for what nobody can say."""
        try:
            name = _valid_name(topic.name)
            if name.lstrip("/") != topic.name.lstrip("/"):
                self.get_logger().warning(f"{topic.name} is played as {name}")
            profile = _profile(joint_offer(topic))
            return self.create_publisher(_type_of(topic), name, profile)
        except NavetteError as error:
            self.get_logger().warning(f"{topic.name} is not played: {error}")
            return None

    def _serve(self) -> None:
        for name, (kind, answer) in SERVICES.items():
            self.create_service(kind, f"~/{name}", partial(answer, self))


class _Without:
    """A source without one of its topics."""

    def __init__(self, source: Source, name: str) -> None:
        self._source = source
        self.topics = tuple(t for t in source.topics if t.name != name)
        self.start_ns, self.end_ns = source.start_ns, source.end_ns
        self.messages = source.messages


def _valid_name(name: str) -> str:
    """ROS 1 took more signs in names, and names without a slash as global ones."""
    parts = (re.sub(r"[^A-Za-z0-9_]", "_", part) for part in name.split("/") if part)
    return "".join(f"/_{p}" if p[0].isdigit() else f"/{p}" for p in parts)


def _type_of(topic: BagTopic) -> type:
    """The class of a recorded topic: as recorded, where the file says how."""
    if topic.definition:
        return register_definition(topic.type_name, topic.definition, private=True)
    return get_interface(topic.type_name)


def _profile(offer: OfferedQos) -> QoSProfile:
    return QoSProfile(
        history=HistoryPolicy.get_from_short_key(offer.history),
        depth=offer.depth,
        reliability=ReliabilityPolicy.get_from_short_key(offer.reliability),
        durability=DurabilityPolicy.get_from_short_key(offer.durability),
        deadline=Duration(nanoseconds=offer.deadline_ns),
    )
