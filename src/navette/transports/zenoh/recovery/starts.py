"""From which number on a subscription is owed something: who waits to be told."""

import threading
from collections import defaultdict
from collections.abc import Callable, Iterable

from navette.transports.zenoh.kin import is_kin
from navette.transports.zenoh.recovery.hearer import Hearer
from navette.transports.zenoh.recovery.hearing import Hearing
from navette.transports.zenoh.recovery.mail import Head, Kind, Letter, letters

# A publisher of Navette's writes when it is matched. It is asked when that letter does
# not come, so many ticks in all; then what has come is all that there is.
_LETTER_TICKS = 4
# Who has no token by then has none at all.
_TOKEN_TICKS = 2
# Whoever calls itself something else each time is not waited for any more.
_MOST_WAITING = 20_000


class Starts:
    """Holds up the first samples of a publisher until its first letter has come.

    Otherwise one that was lost before them would not be missed, or could not be put
    in its place any more.

    Args:
        post: sends a letter.
        watch: called when there is something to look at with every tick.
    """

    def __init__(
        self,
        hearing: Hearing,
        post: Callable[[str, Letter], None],
        watch: Callable[[], None],
    ) -> None:
        self._hearing = hearing
        self._post = post
        self._watch = watch
        self._waiting: dict[tuple[Hearer, bytes], int] = {}
        self._lock = threading.Lock()

    def expects(self, session: str | None) -> bool:
        """Whether a publisher of that session (None: not known yet) will write."""
        return session is None or is_kin(session)

    def await_letter(self, hearer: Hearer, gid: bytes) -> None:
        """Something is held up there."""
        with self._lock:
            has_room = len(self._waiting) < _MOST_WAITING
            if has_room:
                self._waiting.setdefault((hearer, gid), 0)
        if not has_room:
            hearer.start(gid)
        self._watch()

    def drop(self, hearer: Hearer) -> None:
        """It is closed."""
        with self._lock:
            for key in [key for key in self._waiting if key[0] is hearer]:
                del self._waiting[key]

    def on_closed(self, gids: Iterable[bytes]) -> None:
        """Those publishers write no more."""
        gone = set(gids)
        self._start(lambda gid: gid in gone)

    def on_bye(self, session: str) -> None:
        """That session writes no more."""
        self._start(lambda gid: self._hearing.home(gid) == session)

    def tick(self) -> None:
        """A second has gone by."""
        asked: defaultdict[str, set[bytes]] = defaultdict(set)
        over = set()
        with self._lock:
            for (hearer, gid), ticks in list(self._waiting.items()):
                home = self._hearing.home(gid)
                if not hearer.is_held_up(gid):
                    del self._waiting[hearer, gid]
                elif ticks + 1 >= (_TOKEN_TICKS if home is None else _LETTER_TICKS):
                    over.add(gid)
                else:
                    self._waiting[hearer, gid] = ticks + 1
                    if home is not None:
                        asked[home].add(gid)
        for session, gids in asked.items():
            for letter in letters(Kind.WHERE, [Head(gid, 0) for gid in gids]):
                self._post(session, letter)
        if over:
            self._start(lambda gid: gid in over)

    def _start(self, is_over: Callable[[bytes], bool]) -> None:
        with self._lock:
            over = [key for key in self._waiting if is_over(key[1])]
            for key in over:
                del self._waiting[key]
        for hearer, gid in over:
            hearer.start(gid)
