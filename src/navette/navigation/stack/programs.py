"""Nodes of programs that run in the context of a run."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from navette.runtime import Context, Node
from navette.runtime.context import Scope, current_scope

MakeNode = Callable[[Context], Node]
"""Makes a node in a context, which is also the default one meanwhile."""


@contextmanager
def default_context(context: Context) -> Iterator[None]:
    """Make a context the default one, for nodes of programs."""
    token = current_scope.set(Scope(context.graph, default=context))
    try:
        yield
    finally:
        current_scope.reset(token)
