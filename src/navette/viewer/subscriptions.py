"""Topics as channels, and which clients are subscribed to them.

The program keeps one subscription (:class:`~navette.viewer.session.Watch`) per channel
while a client reads it or its last message is cached.
"""

import itertools
from collections.abc import Iterable, Mapping, Set
from functools import partial

from navette.viewer import frames, replies
from navette.viewer.command_queue import CommandRunner
from navette.viewer.grid_copies import GridCopies
from navette.viewer.large_grid import Payload
from navette.viewer.last_value_cache import LastValueCache
from navette.viewer.outbox import MessageFrame
from navette.viewer.replies import Channel, Level
from navette.viewer.session import ProgramCommands, Session, Topic, Watch
from navette.viewer.traffic import Traffic

_SHARED = 0  # lane of the subscriptions that clients share


class Subscriptions:
    """Channels of the program's topics and the clients' subscriptions to them.

    Args:
        sessions: the connected clients by id.
    """

    def __init__(
        self,
        program: ProgramCommands,
        commands: CommandRunner,
        sessions: Mapping[int, Session],
    ) -> None:
        self._program = program
        self._commands = commands
        self._sessions = sessions
        self._channels: dict[int, Channel] = {}
        self._topics: dict[Topic, Channel] = {}
        self._watchers: dict[Watch, set[int]] = {}
        self._last = LastValueCache()
        self._traffic = Traffic()
        self._channel_ids = itertools.count(1)
        #: Encoded once for any number of clients that join.
        self.advertisement = replies.advertise(())

    @property
    def channels(self) -> tuple[Channel, ...]:
        return tuple(self._channels.values())

    # -- topics and messages of the program -------------------------------------

    def set_topics(self, topics: Iterable[Topic]) -> None:
        wanted = dict.fromkeys(topics)
        gone = [self._topics.pop(topic) for topic in list(self._topics.keys() - wanted)]
        for channel in gone:
            self._remove_channel(channel)
        if gone:
            self._broadcast(replies.unadvertise(sorted(channel.id for channel in gone)))
        added = []
        for topic in wanted:
            if topic not in self._topics:
                channel = Channel(
                    next(self._channel_ids),
                    topic.name,
                    topic.type_name,
                    topic.definition,
                    topic.latched,
                )
                self._topics[topic] = self._channels[channel.id] = channel
                added.append(channel)
        if added:
            self._broadcast(replies.advertise(added))
        if gone or added:
            self.advertisement = replies.advertise(self._channels.values())

    def set_published(self, names: Set[str]) -> None:
        """Cache the last message of the topics that have a publisher."""
        for topic, channel in self._topics.items():
            if topic.is_kept:
                self._keep(channel, is_published=topic.name in names)

    def message(self, watch: Watch, stamp_ns: int, payload: Payload) -> None:
        channel_id = watch.channel.id
        self._traffic.add(channel_id, len(payload))
        for client in self._watchers.get(watch, ()):
            session = self._sessions[client]
            subscription_id = session.subscription_by_channel[channel_id]
            frame = MessageFrame(subscription_id, stamp_ns, payload)
            session.put(watch.channel, frame)
        if channel_id in self._last:
            self._last.store(channel_id, stamp_ns, payload)
            self._drop_unwatched(watch)

    def drop_messages(self) -> None:
        """Drop cached and queued messages: they are from before a seek."""
        self._last.clear()
        self.clear_grid_copies()
        for session in self._sessions.values():
            for subscription_id in session.channel_by_subscription:
                session.outbox.forget(subscription_id)

    def clear_grid_copies(self) -> None:
        """Note that all clients drop their grids: time went back."""
        for session in self._sessions.values():
            if session.grid_copies is not None:
                session.grid_copies.clear()

    # -- requests of clients ------------------------------------------------------

    def subscribe(self, session: Session, request: frames.Subscribe) -> None:
        problems = []
        for subscription_id, channel_id in request.subscriptions:
            channel = self._channels.get(channel_id)
            if channel is None:
                problems.append(f"unknown channel id {channel_id}")
            elif subscription_id in session.channel_by_subscription:
                problems.append(f"id {subscription_id} is in use")
            elif channel_id in session.subscription_by_channel:
                problems.append(f"channel {channel_id} ({channel.topic}) is subscribed")
            else:
                session.channel_by_subscription[subscription_id] = channel_id
                session.subscription_by_channel[channel_id] = subscription_id
                self._add_watcher(session, channel)
        session.send_problems("subscribe", problems)

    def unsubscribe(self, session: Session, request: frames.Unsubscribe) -> None:
        problems = []
        for subscription_id in request.subscription_ids:
            if subscription_id in session.channel_by_subscription:
                self._end(session, subscription_id)
            else:
                problems.append(f"unknown subscription id {subscription_id}")
        session.send_problems("unsubscribe", problems, Level.WARNING)

    def end_all(self, session: Session) -> None:
        """End the subscriptions of a client that leaves."""
        for subscription_id in list(session.channel_by_subscription):
            self._end(session, subscription_id)

    def apply_grid_updates(
        self, session: Session, _request: frames.ApplyGridUpdates
    ) -> None:
        if session.grid_copies is None:
            session.grid_copies = GridCopies(session.outbox)

    # -- clients that do not read ---------------------------------------------------

    def suspend(self, session: Session) -> None:
        """Deliver no more streams to a client that does not read.

        Topics that no other client shows are no longer subscribed, so that no camera
        is rendered for it. What is sent rarely (goals, states) is queued further: the
        next message may not come. Called again while the client does not read, since
        a topic may become a stream.
        """
        session.is_suspended = True
        for channel_id in session.subscription_by_channel:
            channel = self._channels[channel_id]
            is_stream = channel_id in self._traffic.streams and not channel.latched
            if is_stream and channel_id not in session.suspended_channels:
                session.suspended_channels.add(channel_id)
                self._remove_watcher(session, channel)

    def resume(self, session: Session) -> None:
        """Deliver streams again, from the newest message on."""
        session.is_suspended = False
        for channel_id in session.suspended_channels:
            self._add_watcher(session, self._channels[channel_id])
        session.suspended_channels.clear()

    def end_period(self) -> None:
        """Count the messages of the next period; called at a constant rate."""
        self._traffic.end_period()

    # -- internals --------------------------------------------------------------------

    def _end(self, session: Session, subscription_id: int) -> None:
        channel_id = session.channel_by_subscription.pop(subscription_id)
        del session.subscription_by_channel[channel_id]
        session.outbox.forget(subscription_id)
        if session.grid_copies is not None:
            session.grid_copies.forget(subscription_id)
        if channel_id in session.suspended_channels:
            session.suspended_channels.discard(channel_id)
        else:
            self._remove_watcher(session, self._channels[channel_id])

    def _remove_channel(self, channel: Channel) -> None:
        is_kept = channel.id in self._last
        self._last.close(channel.id)
        for session in self._sessions.values():
            subscription_id = session.subscription_by_channel.get(channel.id)
            if subscription_id is not None:
                self._end(session, subscription_id)
        watch = Watch(channel, None)
        if is_kept and watch in self._watchers:  # subscribed for the cache only
            self._drop_unwatched(watch)
        del self._channels[channel.id]

    def _add_watcher(self, session: Session, channel: Channel) -> None:
        watch = _watch_of(session, channel)
        watchers = self._watchers.get(watch)
        if watchers is None:
            self._watchers[watch] = {session.id}
            self._watch(watch)
            return
        watchers.add(session.id)
        last = self._last.last(channel.id)
        if last is not None:
            subscription_id = session.subscription_by_channel[channel.id]
            session.put(channel, MessageFrame(subscription_id, *last))

    def _remove_watcher(self, session: Session, channel: Channel) -> None:
        watch = _watch_of(session, channel)
        self._watchers[watch].discard(session.id)
        self._drop_unwatched(watch)

    def _keep(self, channel: Channel, *, is_published: bool) -> None:
        """Subscribe without a client while the topic has a publisher."""
        watch = Watch(channel, None)
        if not is_published:
            self._last.close(channel.id)
            if watch in self._watchers:
                self._drop_unwatched(watch)
        elif self._last.open(channel.id) and watch not in self._watchers:
            self._watchers[watch] = set()
            self._watch(watch)

    def _drop_unwatched(self, watch: Watch) -> None:
        """Unsubscribe from a topic without clients, unless it is cached."""
        if not self._watchers[watch] and watch.channel.id not in self._last:
            del self._watchers[watch]
            self._unwatch(watch)

    def _watch(self, watch: Watch) -> None:
        command = partial(self._program.watch, watch)
        self._commands.add(watch.client or _SHARED, command, watch)

    def _unwatch(self, watch: Watch) -> None:
        command = partial(self._program.unwatch, watch)
        self._commands.add(watch.client or _SHARED, command, watch, is_next=True)

    def _broadcast(self, frame: str | bytes) -> None:
        for session in self._sessions.values():
            session.send(frame)


def _watch_of(session: Session, channel: Channel) -> Watch:
    return Watch(channel, session.id if channel.latched else None)
