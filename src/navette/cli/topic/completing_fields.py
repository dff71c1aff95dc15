"""What the shell offers at Tab behind ``--field``."""

from collections.abc import Iterable
from contextlib import suppress
from typing import TYPE_CHECKING

import typer

from navette.cli.completing import running
from navette.cli.completing_installed import chosen
from navette.cli.session import endpoints
from navette.errors import NavetteError

if TYPE_CHECKING:
    from navette.runtime import Node


def complete_fields(ctx: typer.Context, incomplete: str) -> list[str]:
    """Paths to the fields of a topic's messages: the next names, and those below."""
    from navette.cli.message_types import full_type_name, installed_class
    from navette.msgs import type_name
    from navette.msgs.field_path import field_paths

    def types(here: "Node") -> Iterable[str]:
        topic = here.resolve_topic_name(str(ctx.params.get("topic") or ""))
        return (end.type_name for end in endpoints(here, topic))

    names = [str(ctx.params.get("type_name") or "")]
    for name in filter(None, names if names[0] else running("", types)):
        with suppress(NavetteError):
            cls = installed_class(full_type_name(name, "msg"))
            if cls is not None:
                return chosen(incomplete, field_paths(incomplete, type_name(cls)))
    return []
