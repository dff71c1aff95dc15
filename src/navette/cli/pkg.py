"""``navette pkg``: create and find packages."""

from dataclasses import dataclass
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
    Argument(metavar="NAME", help="Package name.", complete=complete_packages),
]


@dataclass(frozen=True, kw_only=True)
class AboutOptions:
    """Texts of package.xml that the user gave."""

    license_: Annotated[
        str | None, Option("--license", metavar="NAME", help="With --build-type.")
    ] = None
    description: Annotated[
        str | None, Option(metavar="TEXT", help="With --build-type.")
    ] = None
    maintainer_name: Annotated[
        str | None, Option(metavar="NAME", help="With --build-type.")
    ] = None
    maintainer_email: Annotated[
        str | None, Option(metavar="ADDRESS", help="With --build-type.")
    ] = None

    def given(self) -> dict[str, str]:
        """Return them as arguments of PackageAbout."""
        texts = {
            "description": self.description,
            "license": self.license_,
            "maintainer": self.maintainer_name,
            "email": self.maintainer_email,
        }
        return {key: text for key, text in texts.items() if text is not None}


@dataclass(frozen=True, kw_only=True)
class CreateOptions:
    """Options of ``navette pkg create``."""

    name: Name
    msgs: Annotated[
        bool,
        Option(
            "--msgs", help="Also create NAME_msgs for messages, services and actions."
        ),
    ] = False
    node: Annotated[
        str | None,
        Option(
            "--node",
            "--node-name",
            metavar="NODE",
            help="Name of the node. Default: that of the package.",
        ),
    ] = None
    build_type: Annotated[
        str | None,
        Option(
            metavar="TYPE",
            help="ament_python or ament_cmake: the build files only, as ros2 pkg"
            " create writes them.",
        ),
    ] = None
    about: AboutOptions
    dependencies: Annotated[
        list[str] | None,
        Option(metavar="PACKAGE...", help="Additional dependencies.", takes_words=True),
    ] = None
    destination_directory: Annotated[
        Path | None,
        Option(
            metavar="FOLDER",
            help="Parent folder. Default: src/ if it exists, else the current folder.",
        ),
    ] = None

    @property
    def folder(self) -> Path:
        """The parent folder of the package."""
        here = Path.cwd()
        own = here / "src" if (here / "src").is_dir() else here
        return self.destination_directory or own


@pkg.command()
def create(options: CreateOptions) -> None:
    """Create a package with a node, its algorithm, parameters, launch file and tests.

    The tests pass (pytest), colcon builds the package on ROS 2, and Navette runs it
    from its folder. A name that ends with _msgs creates a package of interfaces.
    """
    from navette.ros2.workspace.create import create_package

    if options.build_type is not None:
        made = [_bare(options, options.build_type)]
    elif options.about.given():
        raise click.UsageError(
            "--license, --description and --maintainer-… need --build-type"
        )
    else:
        made = create_package(
            options.name,
            options.folder,
            node=options.node,
            messages=options.msgs,
            dependencies=options.dependencies or (),
        )
    for package in made:
        click.echo(f"made {package}")
        for file in sorted(path for path in package.rglob("*") if path.is_file()):
            click.echo(f"  {file.relative_to(package)}")


def _bare(options: CreateOptions, build_type: str) -> Path:
    """Create the build files only; return the package's folder."""
    from navette.ros2.workspace.create import PackageAbout, create_bare_package

    if options.msgs:
        raise click.UsageError("--msgs and --build-type exclude each other")
    return create_bare_package(
        options.name,
        options.folder,
        build_type,
        node=options.node,
        dependencies=options.dependencies or (),
        about=PackageAbout(**options.about.given()),
    )


@pkg.command("list")
def list_(
    paths: Annotated[
        bool, Option("--paths", help="Also print origin and folder.")
    ] = False,
) -> None:
    """List all packages: of the workspace, installed, and Navette's."""
    from navette.ros2.workspace import find_packages

    for package in find_packages().values():
        place = f"\t{package.origin.value}\t{package.folder}" if paths else ""
        click.echo(f"{package.name}{place}")


@pkg.command()
def prefix(
    name: Found,
    share: Annotated[
        bool, Option("--share", help="Print the share folder instead.")
    ] = False,
) -> None:
    """Print the folder of a package."""
    from navette.ros2.workspace import find_package

    package = find_package(name)
    click.echo(package.share if share else package.prefix)


@pkg.command()
def executables(
    name: Annotated[
        str | None,
        Argument(
            metavar="[NAME]",
            help="Package name. Default: all packages.",
            complete=complete_packages,
        ),
    ] = None,
    full_path: Annotated[
        bool, Option("--full-path", help="Also print the path or function.")
    ] = False,
) -> None:
    """List the executables for navette run PACKAGE EXECUTABLE."""
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
