"""The subscriptions' side: whom to ask for what is missing, and when to stop asking."""

import threading
from collections import deque
from collections.abc import Callable, Iterable
from functools import partial

from navette.transports.zenoh.recovery.answer import Answer, Parts
from navette.transports.zenoh.recovery.errands import Errands
from navette.transports.zenoh.recovery.hearer import Hearer, Want
from navette.transports.zenoh.recovery.hearing import Hearing
from navette.transports.zenoh.recovery.mail import Ask, End
from navette.transports.zenoh.recovery.starts import Starts

# A publisher that cannot be reached is waited for as long as it keeps its samples.
_GRACE_TICKS = 60
# One that can be reached and does not answer is asked so often, a tick apart.
_MOST_TRIES = 3


Get = Callable[[str, Ask, Hearer, Answer], None]


class Wants:
    """Asks each session for one thing at a time.

    Args:
        own_zid: who asks.
        starts: who waits to be told what it is owed at all.
        get: asks a session, for a subscription.
        watch: called when there is something to look at with every tick.
        may_return: whether a publisher of that session that is not seen is only lost.
        max_message_bytes: longer messages are not put together.
    """

    def __init__(
        self,
        own_zid: str,
        hearing: Hearing,
        starts: Starts,
        get: Get,
        watch: Callable[[], None],
        errands: Errands,
        may_return: Callable[[str, bytes], bool],
        max_message_bytes: int,
    ) -> None:
        self.starts = starts
        self._hearing = hearing
        self._watch = watch
        self._own_zid = own_zid
        self._longest = max_message_bytes
        self._get = get
        self._errands = errands
        self._may_return = may_return
        self._wants: dict[tuple[Hearer, bytes], Want] = {}
        self._lines: dict[str, deque[Want]] = {}
        self._busy: set[str] = set()
        self._lock = threading.Lock()

    def drop(self, hearer: Hearer) -> None:
        """It is closed."""
        with self._lock:
            for key in [key for key in self._wants if key[0] is hearer]:
                del self._wants[key]

    def on_closed(self, gids: Iterable[bytes]) -> None:
        """Those publishers do not come back."""
        gone = set(gids)
        self._forsake(lambda want: want.gid in gone)

    def on_bye(self, session: str) -> None:
        """That session does not come back."""
        self._forsake(lambda want: self._hearing.home(want.gid) == session)

    def retry(self, gid: bytes) -> None:
        """A publisher is back."""
        with self._lock:
            for want in [w for w in self._wants.values() if w.is_parked]:
                if want.gid == gid:
                    want.tries = 0
                    self._queue(want)

    # -- asking ----------------------------------------------------------------

    def can_ask(self, gid: bytes) -> bool:
        """Whether there is somebody to ask for that publisher's samples."""
        return self._hearing.home(gid) is not None

    def want(self, hearer: Hearer, gid: bytes) -> None:
        """Something is missing there; nothing new where it is asked for already."""
        with self._lock:
            if (hearer, gid) not in self._wants:
                want = Want(hearer, gid, Parts(self._longest))
                self._wants[hearer, gid] = want
                self._queue(want)
        self._watch()

    def tick(self) -> None:
        """A second has gone by."""
        hopeless = []
        with self._lock:
            for want in [w for w in self._wants.values() if w.is_parked]:
                want.ticks += 1
                is_heard = self._hearing.hears(want.hearer, want.gid)
                if is_heard and want.tries < _MOST_TRIES:
                    self._queue(want)
                elif is_heard or not self._is_awaited(want):
                    hopeless.append(want)
        self._forsake(lambda want: want in hopeless)

    def _is_awaited(self, want: Want) -> bool:
        """Whether a publisher that is not seen may come back in time."""
        home = self._hearing.home(want.gid)
        may_return = home is not None and self._may_return(home, want.gid)
        return may_return and want.ticks < _GRACE_TICKS

    def _queue(self, want: Want) -> None:
        session = self._hearing.home(want.gid)
        want.is_parked = session is None
        if session is None:
            want.tries = _MOST_TRIES
            return
        self._lines.setdefault(session, deque()).append(want)
        if session not in self._busy:
            self._busy.add(session)
            self._go_on(session)

    def _go_on(self, session: str) -> None:
        if not self._lines.get(session):
            self._lines.pop(session, None)
            self._busy.discard(session)
        elif not self._errands.do(partial(self._ask_next, session)):
            # At the end of all, or with too much to do: the next tick tries again.
            self._busy.discard(session)
            for want in self._lines.pop(session, ()):
                want.is_parked = True

    def _ask_next(self, session: str) -> None:
        """Ask for the next thing that is still missing; in a thread of the errands."""
        while True:
            with self._lock:
                line = self._lines.get(session)
                if not line:
                    self._lines.pop(session, None)
                    self._busy.discard(session)
                    return
                want = line.popleft()
            gap = self._still_missing(want)
            if gap is None:
                continue
            offset = want.parts.offset(gap[0]) if want.takes_long else -1
            ask = Ask(want.gid, *gap, offset, self._own_zid)
            take = partial(want.hearer.recover, want.gid)
            ended = partial(self._ended, session, want, ask)
            answer = Answer(want.parts, take, ended)
            self._get(session, ask, want.hearer, answer)
            return

    def _ended(
        self, session: str, want: Want, ask: Ask, end: End | None, has_come: bool
    ) -> None:
        """The answer is over; on any thread."""
        if end is not None:
            has_come |= end.covered >= ask.first or end.is_long > ask.takes_long
            want.takes_long = end.is_long
            want.hearer.give_up(want.gid, min(end.covered, ask.last))
        want.tries = 0 if has_come else want.tries + 1
        gap = self._still_missing(want)
        with self._lock:
            if gap is not None and want.tries:
                want.is_parked = True
                want.ticks = 0
            elif gap is not None:
                self._lines.setdefault(session, deque()).append(want)
            self._go_on(session)

    def _still_missing(self, want: Want) -> tuple[int, int] | None:
        """What to ask for; the want is over where there is nothing."""
        key = want.hearer, want.gid
        with self._lock:
            if self._wants.get(key) is not want:
                return None  # closed or forsaken meanwhile
            del self._wants[key]
        gap = want.hearer.missing(want.gid)
        if gap is None:
            return None
        with self._lock:
            # What came up in between has a want of its own.
            return gap if self._wants.setdefault(key, want) is want else None

    def _forsake(self, is_hopeless: Callable[[Want], bool]) -> None:
        with self._lock:
            hopeless = [want for want in self._wants.values() if is_hopeless(want)]
            for want in hopeless:
                del self._wants[want.hearer, want.gid]
        for want in hopeless:
            want.hearer.give_up(want.gid, None)
