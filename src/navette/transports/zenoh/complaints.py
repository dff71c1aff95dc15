"""What is wrong with others' traffic: logged once a subject, not once a message."""

import logging
import threading
from collections import Counter

_log = logging.getLogger("navette.transports.zenoh")

# A hostile peer may call itself something else each time. Who floods one topic must
# neither flood the log nor silence what is said about another.
_MOST_OF_A_PLACE = 5
_MOST_PLACES = 1000


class Complaints:
    """Logs the first of each subject, and of endless subjects the first few."""

    def __init__(self) -> None:
        self._made: set[tuple[str, ...]] = set()
        self._count_at: Counter[tuple[str, ...]] = Counter()
        self._lock = threading.Lock()

    def once(self, subject: tuple[str, ...], text: str) -> None:
        """Log ``text`` as a warning, unless there was one on ``subject``.

        Args:
            subject: what it is about (a kind, a topic, …); the last says whose it is.
        """
        place = subject[:-1]
        with self._lock:
            count = self._count_at[place]
            is_known = subject in self._made or count >= _MOST_OF_A_PLACE
            if is_known or (not count and len(self._count_at) > _MOST_PLACES):
                return
            self._made.add(subject)
            self._count_at[place] += 1
        if count + 1 == _MOST_OF_A_PLACE:
            text += " (nothing more will be said about others that do so)"
        _log.warning("%s", text)
