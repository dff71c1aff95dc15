"""Every fuzz test runs with bounded memory."""

from collections.abc import Iterator

import pytest

from fuzz.limits import limited_memory


@pytest.fixture(autouse=True)
def _bounded_memory() -> Iterator[None]:
    with limited_memory():
        yield
