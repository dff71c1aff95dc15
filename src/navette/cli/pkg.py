"""``navette pkg``: create and find packages."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import click

from navette.cli.commands import Group
from navette.cli.completing_installed import complete_packages
from navette.cli.options import Argument, Option

if TYPE_CHECKING:
    from navette.ros2.workspace import Package

pkg = Group(
    name="pkg",
    help="Create and find packages; packages of the workspace need no build.",
)

Name = Annotated[str, Argument(metavar="NAME", help="Package name.")]
Found = Annotated[
    str,
    Argument(metavar="NAME", help="The package's name.", complete=complete_packages),
]


@pkg.command()
def create(
    name: Name,
    msgs: Annotated[
        bool,
        Option(
            "--msgs", help="Also make NAME_msgs: own messages, services and actions."
        ),
    ] = False,
    node: Annotated[
        str | None,
        Option(metavar="NODE", help="The node's name; by default the package's."),
    ] = None,
    dependencies: Annotated[
        list[str] | None,
        Option(metavar="PACKAGE...", help="Further packages it needs."),
    ] = None,
    destination_directory: Annotated[
        Path | None,
        Option(
            metavar="FOLDER", help="Where to; by default src/ if that is here, or here."
        ),
    ] = None,
) -> None:
    """Make a package: a node, its method apart, parameters, launch file and tests.

    Its tests pass at once (pytest), colcon builds it on ROS 2, and Navette runs it
    from its folder. A name that ends in _msgs makes a package of interfaces.
    """
    from navette.ros2.workspace import create_package

    here = Path.cwd()
    folder = destination_directory or (
        here / "src" if (here / "src").is_dir() else here
    )
    made = create_package(
        name, folder, node=node, messages=msgs, dependencies=dependencies or ()
    )
    for package in made:
        click.echo(f"made {package}")
        for file in sorted(path for path in package.rglob("*") if path.is_file()):
            click.echo(f"  {file.relative_to(package)}")


@pkg.command("list")
def list_(
    paths: Annotated[bool, Option("--paths", help="With origin and folder.")] = False,
) -> None:
    """List all packages: the workspace's, installed ones and Navette's own."""
    from navette.ros2.workspace import find_packages

    for package in find_packages().values():
        place = f"\t{package.origin.value}\t{package.folder}" if paths else ""
        click.echo(f"{package.name}{place}")


@pkg.command()
def prefix(
    name: Found,
    share: Annotated[
        bool, Option("--share", help="The folder of its files instead.")
    ] = False,
) -> None:
    """Print where a package is."""
    from navette.ros2.workspace import find_package

    package = find_package(name)
    click.echo(package.share if share else package.prefix)


@pkg.command()
def executables(
    name: Annotated[
        str | None,
        Argument(
            metavar="[NAME]",
            help="Only of this package.",
            complete=complete_packages,
        ),
    ] = None,
    full_path: Annotated[
        bool, Option("--full-path", help="Say what each of them runs.")
    ] = False,
) -> None:
    """List the programs that navette run PACKAGE EXECUTABLE can run."""
    from navette.ros2.workspace import find_package, find_packages

    packages = [find_package(name)] if name else list(find_packages().values())
    for package in packages:
        for line in _lines(package, full_path=full_path):
            click.echo(line)


def _lines(package: "Package", *, full_path: bool) -> list[str]:
    lines = []
    for each in package.executables():
        runs = each.path or f"{each.module}:{each.attribute}"
        lines.append(f"{package.name} {each.name}" + (f"\t{runs}" if full_path else ""))
    return lines
