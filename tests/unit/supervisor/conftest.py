"""Real processes for tests."""

from collections.abc import Iterator

import pytest
from process_bench import Bench


@pytest.fixture
def bench() -> Iterator[Bench]:
    made = Bench()
    yield made
    made.manager.close()
