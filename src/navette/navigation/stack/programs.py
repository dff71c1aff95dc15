"""Nodes of programs that run in the context of a run."""

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager

from navette.errors import UnknownNameError
from navette.runtime import Context, Node
from navette.runtime.context import Scope, current_scope

MakeNode = Callable[[Context], Node]
"""Makes a node in a context, which is also the default one meanwhile."""

_REPLACEABLE = (
    "localizer",
    "costmap",
    "tracking",
    "map_memory",
    "planner",
    "control",
    "behaviors",
)


def check_replaceable(names: Iterable[str]) -> None:
    """Check that programs of the user can replace the nodes of these names.

    Raises:
        UnknownNameError: no such node of the stack, or one that cannot be replaced.
    """
    for name in names:
        if name not in _REPLACEABLE:
            raise UnknownNameError.of("node to replace", name, [*_REPLACEABLE])


@contextmanager
def default_context(context: Context) -> Iterator[None]:
    """Make a context the default one, for nodes of programs."""
    token = current_scope.set(Scope(context.graph, default=context))
    try:
        yield
    finally:
        current_scope.reset(token)
