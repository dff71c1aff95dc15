# SPDX-License-Identifier: Apache-2.0
"""Hold signals back where an exception of their handler would be lost."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

_SIGNALS = (signal.SIGINT, signal.SIGTERM)


@contextmanager
def held_signals() -> Iterator[None]:
    """Call the handlers of SIGINT and SIGTERM after the block.

    Python runs a handler at the next bytecode of the main thread. In a callback from C
    that is inside of it, and ctypes prints and drops the KeyboardInterrupt.
    """
    if threading.current_thread() is not threading.main_thread():
        yield  # handlers run in the main thread
        return
    received: list[tuple[int, FrameType | None]] = []
    before: dict[int, Any] = {}
    for number in _SIGNALS:
        handler = signal.getsignal(number)
        if callable(handler):  # not ignored, and not the system's default
            before[number] = handler
            signal.signal(number, lambda *arguments: received.append(arguments))
    try:
        yield
    finally:
        for held, handler in before.items():
            signal.signal(held, handler)
        for arrived, frame in received:
            before[arrived](arrived, frame)
