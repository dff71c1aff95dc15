"""``navette keys``: certificates, so that only one's own machines join."""

from pathlib import Path
from typing import Annotated

import typer

keys = typer.Typer(
    name="keys",
    help="Keys and certificates for links with mutual TLS.",
    no_args_is_help=True,
)


@keys.command()
def create(
    folder: Annotated[
        Path, typer.Argument(help="Where the authority's keys are kept.")
    ],
    names: Annotated[
        list[str], typer.Argument(metavar="NAME...", help="robot, laptop, anna, …")
    ],
    days: Annotated[
        int, typer.Option(min=1, max=3650, help="Valid for so long.")
    ] = 365,
) -> None:
    """Make a folder of keys for each NAME; the authority is made once.

    Copy FOLDER/NAME to that machine and set NAVETTE_SECURITY to it there.
    """
    import datetime

    from navette.runtime import SystemClock
    from navette.transports.certificates import create_keys

    now = datetime.datetime.fromtimestamp(SystemClock().now_ns / 1e9, datetime.UTC)
    for made in create_keys(folder, names, now=now, days=days):
        typer.echo(f"made {made}: NAVETTE_SECURITY={made}")
    typer.echo(f"{folder / 'ca.key'} signs further ones: leave it where it is")


@keys.command()
def show(
    folder: Annotated[Path, typer.Argument(help="What NAVETTE_SECURITY would be.")],
) -> None:
    """Say what a folder asks of links, and check its files."""
    from navette.transports.zenoh.security import Security

    for line in Security(folder).describe():
        typer.echo(line)
