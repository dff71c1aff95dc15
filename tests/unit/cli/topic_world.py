"""A small world for the verbs: programs in contexts of their own on one graph."""

from collections.abc import Iterator
from contextlib import contextmanager

from click.testing import CliRunner, Result

from navette.cli.app import app
from navette.runtime import Context, ContextClock, Executor, Node
from navette.runtime.context import Scope, current_scope, new_graph


@contextmanager
def shared_graph() -> Iterator[None]:
    """Contexts made inside see each other, those of the verbs too."""
    graph = new_graph()
    token = current_scope.set(Scope(graph))
    try:
        yield
    finally:
        current_scope.reset(token)
        graph.close()


@contextmanager
def program(name: str, *, clock: ContextClock | None = None) -> Iterator[Node]:
    """A node in a context of its own; its callbacks run when that context spins."""
    with Context(clock=clock) as context:
        node = Node(name, context=context, start_parameter_services=False)
        Executor(context=context).add_node(node)
        yield node


def navette(*arguments: str) -> Result:
    """Run a verb in this process; what it printed and its exit code."""
    return CliRunner().invoke(app, list(arguments))
