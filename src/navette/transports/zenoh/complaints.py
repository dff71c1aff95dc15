"""What is wrong with others' traffic: logged once a subject, not once a message."""

import logging
import threading

_log = logging.getLogger("navette.transports.zenoh")

# A hostile peer may make up subjects without end.
_MOST = 1000


class Complaints:
    """Logs the first of each subject; of endless subjects the first thousand."""

    def __init__(self) -> None:
        self._made: set[tuple[str, ...]] = set()
        self._lock = threading.Lock()

    def once(self, subject: tuple[str, ...], text: str) -> None:
        """Log ``text`` as a warning, unless there was one on ``subject``."""
        with self._lock:
            if subject in self._made or len(self._made) >= _MOST:
                return
            self._made.add(subject)
        _log.warning("%s", text)
