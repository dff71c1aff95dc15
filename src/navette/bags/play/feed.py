"""Message feed of a bag: read on demand, or ahead by a thread."""

import threading
from collections import deque
from collections.abc import Callable, Iterator
from typing import Protocol

from navette.bags.bag import BagMessage
from navette.errors import NavetteError

_MAX_BYTES = 16 * 2**20
_MAX_MESSAGES = 2000


class Feed(Protocol):
    """Iterator over messages with lookahead of one."""

    def peek(self) -> BagMessage | None:
        """Return the next message without removing it; None at the end."""

    def pop(self) -> BagMessage | None:
        """Remove and return the next message; None at the end."""

    def close(self) -> None:
        """Stop reading; the bag may be read elsewhere afterwards."""


MakeFeed = Callable[[Iterator[BagMessage]], Feed]


class DirectFeed:
    """Reads on demand."""

    def __init__(self, messages: Iterator[BagMessage]) -> None:
        self._messages = messages
        self._next: BagMessage | None = None

    def peek(self) -> BagMessage | None:
        if self._next is None:
            self._next = next(self._messages, None)
        return self._next

    def pop(self) -> BagMessage | None:
        message, self._next = self.peek(), None
        return message

    def close(self) -> None:
        self._messages = iter(())
        self._next = None


class PrefetchingFeed:
    """Reads ahead in a thread, so that a slow disk does not delay messages.

    The lookahead is bounded in messages and bytes.
    """

    def __init__(self, messages: Iterator[BagMessage]) -> None:
        self._messages = messages
        self._queue: deque[BagMessage] = deque()
        self._bytes = 0
        self._done = False
        self._error: NavetteError | OSError | None = None
        self._changed = threading.Condition()
        self._thread = threading.Thread(
            target=self._run, name="navette-bag-reader", daemon=True
        )
        self._thread.start()

    def peek(self) -> BagMessage | None:
        with self._changed:
            self._changed.wait_for(lambda: self._queue or self._done)
            if self._queue:
                return self._queue[0]
        if self._error is not None:
            raise self._error
        return None

    def pop(self) -> BagMessage | None:
        message = self.peek()
        if message is not None:
            with self._changed:
                self._queue.popleft()
                self._bytes -= len(message.data)
                self._changed.notify_all()
        return message

    def close(self) -> None:
        with self._changed:
            self._done = True
            self._queue.clear()
            self._changed.notify_all()
        self._thread.join()

    def _run(self) -> None:
        try:
            for message in self._messages:
                if not self._put(message):
                    return
        except (NavetteError, OSError) as error:  # raised again in the reading thread
            self._error = error
        with self._changed:
            self._done = True
            self._changed.notify_all()

    def _put(self, message: BagMessage) -> bool:
        """Queue a message when there is space; False if the feed is closed."""
        with self._changed:
            self._changed.wait_for(lambda: self._done or self._has_room())
            if self._done:
                return False
            self._queue.append(message)
            self._bytes += len(message.data)
            self._changed.notify_all()
            return True

    def _has_room(self) -> bool:
        return self._bytes < _MAX_BYTES and len(self._queue) < _MAX_MESSAGES
