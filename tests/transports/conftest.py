"""Fixtures of the transports' tests."""

from collections.abc import Iterator

import pytest
from transport_pairs import ZenohPair


@pytest.fixture
def pair() -> Iterator[ZenohPair]:
    """Two connected Zenoh transports in this process."""
    pair = ZenohPair()
    yield pair
    pair.close()
