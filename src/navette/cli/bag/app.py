"""The verbs of ``navette bag``."""

import typer

from navette.cli.bag.play import play

bag = typer.Typer(
    name="bag",
    help="Recordings: play them to whoever listens.",
    no_args_is_help=True,
)
bag.command()(play)


@bag.callback()
def _verbs() -> None:
    """Recordings."""
