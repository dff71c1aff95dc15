"""A graph in virtual time for each test."""

from collections.abc import Iterator

import pytest

from navette.runtime.testing import GraphHarness


@pytest.fixture
def graph() -> Iterator[GraphHarness]:
    with GraphHarness() as harness:
        yield harness
