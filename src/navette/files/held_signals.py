# SPDX-License-Identifier: Apache-2.0
"""Hold signals back where an exception of their handler would be lost."""

import signal
import threading
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from functools import partial
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
    with ExitStack() as after:  # each step runs, also if one before it raises
        for number in _SIGNALS:
            handler = signal.getsignal(number)
            if callable(handler):  # not ignored, and not the system's default
                received: list[FrameType | None] = []
                after.callback(_call, handler, number, received)
                after.callback(signal.signal, number, handler)
                signal.signal(number, partial(_note, received))
        yield


def _note(received: list[FrameType | None], _: int, frame: FrameType | None) -> None:
    received.append(frame)


def _call(handler: Any, number: int, received: list[FrameType | None]) -> None:
    for frame in received:
        handler(number, frame)
