"""The verbs of ``navette interface``."""

import sys
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

from navette.cli.commands import Group
from navette.cli.completing_installed import complete_packages, complete_types
from navette.cli.options import Argument, Json, Option
from navette.cli.output import show as put
from navette.cli.output import show_json
from navette.cli.session import fail
from navette.errors import InvalidValueError

if TYPE_CHECKING:
    from navette.cli.interface.listing import Kind

interface = Group(
    name="interface",
    help="Show definitions of messages, services and actions.",
)

TypeName = Annotated[
    str,
    Argument(
        metavar="TYPE",
        help="pkg/msg/Name, pkg/srv/Name or pkg/action/Name. - reads the name from"
        " standard input, as in navette topic type /odom | navette interface show -.",
        complete=complete_types,
    ),
]


@dataclass(frozen=True, kw_only=True)
class KindOptions:
    """Kinds of interfaces to list; none: all."""

    only_msgs: Annotated[bool, Option("--only-msgs", "-m", help="List messages.")] = (
        False
    )
    only_srvs: Annotated[bool, Option("--only-srvs", "-s", help="List services.")] = (
        False
    )
    only_actions: Annotated[
        bool, Option("--only-actions", "-a", help="List actions.")
    ] = False

    @property
    def kinds(self) -> "list[Kind]":
        """The chosen kinds, in a fixed order."""
        from navette.cli.interface import listing

        return listing.chosen_kinds(self.only_msgs, self.only_srvs, self.only_actions)


ALL_KINDS = KindOptions()


@interface.command("show")
def show(
    type_name: TypeName,
    all_comments: Annotated[
        bool, Option("--all-comments", help="Also print comments of nested types.")
    ] = False,
    no_comments: Annotated[
        bool, Option("--no-comments", help="Omit comments and empty lines.")
    ] = False,
) -> None:
    """Print a definition, with nested types indented.

    The definition of a type that is not installed is requested from running nodes.
    """
    from navette.cli.interface.definitions import Comments, definition_lines

    if all_comments and no_comments:
        raise InvalidValueError("--all-comments and --no-comments cannot be combined")
    comments = Comments.OWN
    if all_comments or no_comments:
        comments = Comments.ALL if all_comments else Comments.NONE
    put("\n".join(definition_lines(_typed(type_name), comments)))


@interface.command("list")
def list_(
    only: KindOptions = ALL_KINDS,
    as_json: Json = False,
) -> None:
    """List all interfaces: of Navette, the workspace and installed packages."""
    from navette.cli.interface import listing

    found = {kind: listing.interfaces(kind) for kind in only.kinds}
    if as_json:
        show_json({kind.value: names for kind, names in found.items()})
        return
    for kind, names in found.items():
        put("\n".join([f"{kind.title}:", *(f"    {name}" for name in names)]))


@interface.command()
def package(
    name: Annotated[
        str,
        Argument(
            metavar="PACKAGE",
            help="Package name.",
            complete=complete_packages,
        ),
    ],
    only: KindOptions = ALL_KINDS,
    as_json: Json = False,
) -> None:
    """List the interfaces of a package."""
    from navette.cli.interface import listing

    _put_all(listing.interfaces_of(name, only.kinds), as_json=as_json)


@interface.command()
def packages(
    only: KindOptions = ALL_KINDS,
    as_json: Json = False,
) -> None:
    """List the packages that define interfaces."""
    from navette.cli.interface import listing

    _put_all(listing.packages(only.kinds), as_json=as_json)


def _put_all(names: Iterable[str], *, as_json: bool) -> None:
    if as_json:
        show_json(list(names))
        return
    for name in names:
        put(name)


@interface.command()
def proto(
    type_name: TypeName,
    no_quotes: Annotated[
        bool, Option("--no-quotes", help="Omit the enclosing quotes.")
    ] = False,
) -> None:
    """Print a message, request or goal with its defaults as YAML."""
    from navette.cli.interface.definitions import prototype

    yaml = prototype(_typed(type_name))
    put(yaml if no_quotes else f'"{yaml}"')


def _typed(type_name: str) -> str:
    """Return the name; for ``-`` a line of standard input."""
    if type_name != "-":
        return type_name
    if sys.stdin.isatty():
        raise InvalidValueError("-: standard input is a terminal, pipe a type name")
    name = sys.stdin.readline(1000).strip()
    return name or fail("no type name on standard input")
