"""The command line: the ``navette`` command and its verbs."""

import os

from navette.cli import ending
from navette.cli.gc_tuning import uncollected
from navette.cli.interruption import default_signal_action, obey_interrupts

__all__ = ["main"]


def main() -> None:
    """Entry point of the ``navette`` command, with the fastest possible import."""
    # The first write in one of NumPy's pages of 2 MB takes up to 25 ms on a virtual
    # machine, in which no other thread of Python runs: the robot gets no command.
    os.environ.setdefault("NUMPY_MADVISE_HUGEPAGE", "0")
    ending.register()
    obey_interrupts()
    with default_signal_action(), uncollected():
        from navette.cli.app import main as run

        run()
