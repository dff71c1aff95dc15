"""The command line: ``navette demo``, ``navette sim``."""

from navette.cli.gc_tuning import uncollected
from navette.cli.interruption import default_signal_action

__all__ = ["main"]


def main() -> None:
    """Entry point of the ``navette`` command; quiet at Ctrl-C from here on."""
    with default_signal_action(), uncollected():
        from navette.cli.app import main as run

        run()
