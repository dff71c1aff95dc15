"""``navette keys``: certificates that restrict the network to known machines."""

from pathlib import Path
from typing import Annotated

import click

from navette.cli.commands import Group
from navette.cli.options import Argument, Option

keys = Group(
    name="keys",
    help="Create keys and certificates for mutual TLS.",
)


@keys.command()
def create(
    folder: Annotated[Path, Argument(help="Where the authority's keys are kept.")],
    names: Annotated[
        list[str], Argument(metavar="NAME...", help="robot, laptop, anna, …")
    ],
    days: Annotated[int, Option(min=1, max=3650, help="Valid for so long.")] = 365,
) -> None:
    """Create a folder of keys for each NAME, and the authority if there is none.

    Copy FOLDER/NAME to that machine and set NAVETTE_SECURITY to the copy.
    """
    import datetime

    from navette.runtime import SystemClock
    from navette.transports.certificates import create_keys

    now = datetime.datetime.fromtimestamp(SystemClock().now_ns / 1e9, datetime.UTC)
    for made in create_keys(folder, names, now=now, days=days):
        click.echo(f"made {made}: NAVETTE_SECURITY={made}")
    click.echo(f"{folder / 'ca.key'} signs further ones: leave it where it is")


@keys.command()
def show(
    folder: Annotated[Path, Argument(help="What NAVETTE_SECURITY would be.")],
) -> None:
    """Say what a folder asks of links, and check its files."""
    from navette.transports.zenoh.security import Security

    for line in Security(folder).describe():
        click.echo(line)
