"""When Python looks for garbage: not while a verb loads, and not when all ends.

What a verb imports stays to its end. Python goes through it some ten times while it is
loaded, and again when the process ends: a third of the processor time that a verb
takes, and seconds at the end on a busy machine.
"""

import atexit
import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def uncollected() -> Iterator[None]:
    """Inside, none is looked for until :func:`collect`; never again at the end."""
    # Registered before all others, so that it comes after them.
    atexit.register(gc.freeze)
    gc.disable()
    try:
        yield
    finally:
        gc.enable()


def collect() -> None:
    """All is loaded: what comes now may be garbage one day."""
    gc.enable()
