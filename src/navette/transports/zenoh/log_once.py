"""Warnings about remote traffic: logged once for each subject, not for each message."""

import logging
import threading
from collections import Counter

_log = logging.getLogger("navette.transports.zenoh")

# A hostile peer may use a new name for each message. Warnings about one topic must
# neither flood the log nor suppress those about another topic.
_MAX_PER_TOPIC = 5
_MAX_TOPICS = 1000


class LogOnce:
    """Logs the first warning of each subject, and a limited number for each topic."""

    def __init__(self) -> None:
        self._logged: set[tuple[str, ...]] = set()
        self._count_of: Counter[tuple[str, ...]] = Counter()
        self._lock = threading.Lock()

    def warning(self, subject: tuple[str, ...], text: str) -> None:
        """Log ``text`` unless there was a warning on ``subject`` before.

        Args:
            subject: kind and topic or service, then the peer that caused the warning.
        """
        topic = subject[:-1]
        with self._lock:
            count = self._count_of[topic]
            if subject in self._logged or count >= _MAX_PER_TOPIC:
                return
            if not count and len(self._count_of) > _MAX_TOPICS:
                return
            self._logged.add(subject)
            self._count_of[topic] += 1
        if count + 1 == _MAX_PER_TOPIC:
            text += " (further warnings of this kind are suppressed)"
        _log.warning("%s", text)
