"""What tests of verbs share."""

from collections.abc import Iterator

import pytest

from navette.runtime import Context, Executor, Node, VirtualClock


@pytest.fixture
def talker() -> Iterator[Node]:
    """A node in virtual time; the verb joins its context."""
    with Context(clock=VirtualClock()) as context:
        node = Node("talker", context=context, start_parameter_services=False)
        Executor(context=context).add_node(node)
        yield node
