"""The node ``rosbag2_player``: publish the messages of a bag at the recorded times.

Messages are published as recorded, without decoding. Publishers have the recorded QoS,
so late subscribers receive latched topics; a start in the middle, a loop and a seek
first publish the latched messages of that position. With a clock rate the node is the
source of ``/clock``: a jump is published there before anything else. While nothing
moves, a new subscriber of a topic receives its last message.

Services under the node's name, as of rosbag2's player: pause, resume, toggle_paused,
is_paused, set_rate, get_rate, play_next, seek, stop.
"""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from navette.bags.bag import BagMessage, BagTopic
from navette.bags.message_types import message_class
from navette.bags.play.feed import DirectFeed, PrefetchingFeed
from navette.bags.play.offers import joint_offer
from navette.bags.play.options import PlayOptions
from navette.bags.play.player import LAST_PLAYED_NS, Player, PlayState
from navette.bags.play.services import SERVICES
from navette.bags.play.source import Source
from navette.bags.qos_profiles import profile_of
from navette.errors import NavetteError
from navette.files.untrusted.escaping import escaped
from navette.msgs.rosgraph_msgs.msg import Clock as ClockMsg
from navette.runtime.context import Context
from navette.runtime.events import Call
from navette.runtime.node import Node
from navette.runtime.publisher import Publisher
from navette.runtime.qos import QoSProfile
from navette.runtime.qos_events import PublisherEventCallbacks, QoSMatchedInfo
from navette.runtime.time import ns_to_stamp

CLOCK_TOPIC = "/clock"
_CLOCK_QOS = QoSProfile(depth=1)


@dataclass(frozen=True)
class PlayProgress:
    """State of playback; positions are recording time in nanoseconds."""

    state: PlayState
    position_ns: int
    begin_ns: int
    end_ns: int
    rate: float
    passes: int
    published: int


OnPlaybackEnd = Callable[[], None]
"""Called at the end of the recording."""

OnPlaybackChange = Callable[[bool], None]
"""Called when state, rate or position changed other than by playing; true: a jump."""


class PlayerNode(Node):
    """Plays from :meth:`start`; all methods except :meth:`run_soon` run on the loop.

    Args:
        source: an open bag; the caller closes it.
        remap: rules ``FROM:=TO`` for the topics.
        clock_rate_hz: rate of the recording's time on ``/clock``; a recorded ``/clock``
            is then not played.

    Raises:
        UnknownNameError, InvalidValueError: no recorded topic matches the options.
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
        on_end: OnPlaybackEnd | None = None,
        on_change: OnPlaybackChange | None = None,
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
                make_feed=DirectFeed if lock_step else PrefetchingFeed,
            )
        except NavetteError:
            super().destroy_node()
            raise
        self._clock_publisher = (
            self.create_publisher(ClockMsg, CLOCK_TOPIC, _CLOCK_QOS)
            if clock_rate_hz
            else None
        )
        if source.end_ns > LAST_PLAYED_NS:
            self.get_logger().warning(
                "messages after 2038 are not played: ROS 2 has no such time"
            )
        self._outlets = {t: p for t in self.player.topics if (p := self._open_topic(t))}
        self._serve()

    # -- control ---------------------------------------------------------------

    def start(self) -> None:
        """Start to play, or to pause at the beginning, as the options say."""
        self.player.start(self._now_ns())
        self._tick()
        self._changed(jumped=True)

    def progress(self) -> PlayProgress:
        """Return the state of playback; callable from any thread."""
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
        """Run a function with the player between two callbacks; from any thread."""
        self.context.loop.call_soon_threadsafe(
            action, "player control", self.get_fully_qualified_name()
        )

    def pause(self) -> None:
        self.player.pause(self._now_ns())
        self._changed()

    def resume(self) -> None:
        """Resume; at the end, restart from the beginning."""
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
        """Pause, and publish the next message; False at the end."""
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
        """Set the playback rate relative to the recording.

        Raises:
            InvalidValueError: the rate is out of range.
        """
        self.player.set_rate(self._now_ns(), rate)
        self._changed()

    def seek(self, bag_ns: int) -> None:
        """Seek to a position, or to the nearest one that is played."""
        self.player.seek(self._now_ns(), bag_ns)
        self._changed(jumped=True)

    def seek_by(self, delta_ns: int) -> None:
        self.seek(self.player.position_ns(self._now_ns()) + delta_ns)

    def control(self, *, play: bool, rate: float, seek_ns: int | None) -> None:
        """Seek (optionally), set the rate, and play or pause.

        Raises:
            InvalidValueError: the rate is out of range; nothing is changed.
        """
        player, now_ns = self.player, self._now_ns()
        player.set_rate(now_ns, rate)
        if seek_ns is None and play and player.state is PlayState.ENDED:
            seek_ns = player.begin_ns
        if play:
            player.resume(now_ns)
        else:
            player.pause(now_ns)
        if seek_ns is not None:
            player.seek(now_ns, seek_ns)
        self._changed(jumped=seek_ns is not None)

    def stop(self) -> None:
        """Pause, and end as at the end of the recording."""
        self.pause()
        if self.on_end is not None:
            self.on_end()

    def destroy_node(self) -> None:
        for call in (self._call, self._clock_call):
            if call is not None:
                call.cancel()
        self.player.close()
        super().destroy_node()

    # -- timing ----------------------------------------------------------------

    def _now_ns(self) -> int:
        # Not the node's clock, which may follow the /clock published here.
        return self.context.clock.now_ns

    def _changed(self, *, jumped: bool = False) -> None:
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
        """Publish one message per event, so that subscribers act before the next."""
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
        """Publish time and the last messages after a start, loop or seek."""
        jump = self.player.pop_jump()
        if jump is None:
            return False
        self._publish_clock()
        for message in (*jump.latched, *jump.recent):
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
        """Create a publisher; None, and a warning, if the type cannot be published."""
        try:
            name = _valid_name(topic.name)
            if name.lstrip("/") != topic.name.lstrip("/"):
                self.get_logger().warning(f"{escaped(topic.name)} is played as {name}")
            profile = profile_of(joint_offer(topic))
            return self.create_publisher(
                message_class(topic),
                name,
                profile,
                event_callbacks=PublisherEventCallbacks(
                    matched=partial(self._on_matched, topic)
                ),
            )
        except NavetteError as error:
            self.get_logger().warning(f"{escaped(topic.name)} is not played: {error}")
            return None

    def _on_matched(self, topic: BagTopic, info: QoSMatchedInfo) -> None:
        if info.current_count_change <= 0 or self.player.state is PlayState.PLAYING:
            return
        for message in self.player.last_before(topic, self._now_ns()):
            self._say(message)

    def _serve(self) -> None:
        for name, (kind, answer) in SERVICES.items():
            self.create_service(kind, f"~/{name}", partial(answer, self))


class _Without:
    def __init__(self, source: Source, name: str) -> None:
        self._source = source
        self.topics = tuple(t for t in source.topics if t.name != name)
        self.start_ns, self.end_ns = source.start_ns, source.end_ns
        self.messages = source.messages


def _valid_name(name: str) -> str:
    """Convert a ROS 1 name, which may have more characters and no slash."""
    parts = (re.sub(r"[^A-Za-z0-9_]", "_", part) for part in name.split("/") if part)
    return "".join(f"/_{p}" if p[0].isdigit() else f"/{p}" for p in parts)
