"""The command line: ``navette demo``, ``navette sim``."""

from navette.cli.gc_tuning import uncollected
from navette.cli.interruption import dying_on_signals

__all__ = ["main"]


def main() -> None:
    """Entry point of the ``navette`` command; quiet at Ctrl-C from here on."""
    with dying_on_signals(), uncollected():
        from navette.cli.app import main as run

        run()
