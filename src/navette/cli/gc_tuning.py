"""Disable garbage collection while a verb is imported and when the process exits.

Imported objects live until the end of the process. The collector would traverse them
about ten times during the imports and once more at exit: a third of the CPU time of a
verb, and seconds at exit on a busy machine.
"""

import atexit
import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def uncollected() -> Iterator[None]:
    """Disable the collector until :func:`collect`, and at exit."""
    # The first registered function runs last.
    atexit.register(gc.freeze)
    gc.disable()
    try:
        yield
    finally:
        gc.unfreeze()
        gc.enable()


def collect() -> None:
    """Enable the collector, for new objects only: the imports are done.

    Without effect where the collector is enabled, as in a program that calls a verb.
    """
    if not gc.isenabled():
        gc.freeze()
        gc.enable()
