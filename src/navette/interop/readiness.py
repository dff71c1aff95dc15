"""A program tells whoever started it that its nodes are made and spinning.

As systemd's services do: the starter passes a pipe and its number in the environment.
"""

import contextlib
import os
import threading
from collections.abc import Sequence

from navette.runtime.context import Scope

VARIABLE = "NAVETTE_READY_FD"
_LOOK_S = 0.02


def tell_when_ready(scopes: Sequence[Scope]) -> None:
    """Tell, once, when a context of every scope has nodes and runs; if asked to."""
    number = os.environ.pop(VARIABLE, "")
    if number.isdigit():
        thread = threading.Thread(target=_watch, args=(int(number), scopes))
        thread.daemon = True
        thread.start()


def _watch(pipe: int, scopes: Sequence[Scope]) -> None:
    pause = threading.Event()
    while not all(map(_is_ready, scopes)):
        pause.wait(_LOOK_S)
    # Whoever asked may be gone by now.
    with contextlib.suppress(OSError):
        os.write(pipe, b"ready")
        os.close(pipe)


def _is_ready(scope: Scope) -> bool:
    contexts = tuple(scope.contexts)
    return any(context.nodes and context.loop.is_running for context in contexts)
