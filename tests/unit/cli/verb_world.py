"""Verbs in the context of the nodes that they look at: virtual time, one thread."""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pkgutil import resolve_name
from typing import NamedTuple
from unittest.mock import patch

from click.testing import CliRunner

from navette.cli.app import app
from navette.cli.session import connect
from navette.errors import NavetteError
from navette.runtime.testing import GraphHarness

_JOINING = (
    "action.send_goal",
    "action.listing",
    "cancel",
    "component",
    "completing",
    "doctor.command",
    "lifecycle",
    "map",
    "node",
    "param.verbs",
    "service.call",
    "service.echo",
    "service.listing",
    "stop",
)

# Imported now: under a test that replaces is_terminal, they would keep the replacement.
for _name in _JOINING:
    resolve_name(f"navette.cli.{_name}")


class Done(NamedTuple):
    """What a verb printed, and its exit code."""

    out: str
    err: str
    code: int


class World:
    """A graph in virtual time that verbs join."""

    def __init__(self, graph: GraphHarness) -> None:
        self.graph = graph
        self.context = graph.context
        # The harness' own node is none of those looked at.
        graph.node.destroy_node()

    def run(self, *words: str, stdin: str = "") -> Done:
        """``navette …`` with these words."""
        done = CliRunner().invoke(app, list(words), input=stdin)
        if isinstance(done.exception, NavetteError):
            return Done(done.stdout, f"navette: {done.exception}\n", 2)
        if done.exception and not isinstance(done.exception, SystemExit):
            raise done.exception
        return Done(done.stdout, done.stderr, done.exit_code)

    def read(self, *words: str) -> str:
        """What a verb that succeeds prints."""
        done = self.run(*words)
        assert done.code == 0, done
        return done.out


@contextmanager
def world() -> Iterator[World]:
    with GraphHarness() as graph, joining(graph):
        yield World(graph)


@contextmanager
def joining(graph: GraphHarness) -> Iterator[None]:
    """Let verbs join this graph instead of the network."""
    here = partial(connect, graph.context)
    patches = [patch(f"navette.cli.{name}.connect", here) for name in _JOINING]
    for each in patches:
        each.start()
    try:
        yield
    finally:
        for each in patches:
            each.stop()
