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
    folder: Annotated[Path, Argument(help="Folder of the certificate authority.")],
    names: Annotated[
        list[str],
        Argument(metavar="NAME...", help="Names of machines: robot, laptop, …"),
    ],
    days: Annotated[
        int, Option(min=1, max=3650, help="Validity of the certificates, in days.")
    ] = 365,
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
    click.echo(f"{folder / 'ca.key'} signs further certificates: keep it secret")


@keys.command()
def show(
    folder: Annotated[Path, Argument(help="Folder for NAVETTE_SECURITY.")],
) -> None:
    """Show the requirements of a security folder and check its files."""
    from navette.transports.zenoh.security import Security

    for line in Security(folder).describe():
        click.echo(line)
