"""The command line: the ``navette`` command and its verbs."""

from navette.cli import ending
from navette.cli.gc_tuning import uncollected
from navette.cli.interruption import default_signal_action, obey_interrupts

__all__ = ["main"]


def main() -> None:
    """Entry point of the ``navette`` command, with the fastest possible import."""
    ending.register()
    obey_interrupts()
    with default_signal_action(), uncollected():
        from navette.cli.app import main as run

        run()
