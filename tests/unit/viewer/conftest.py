"""A hub for the tests of its parts."""

from pathlib import Path

import pytest
from viewer_fakes import Bench


@pytest.fixture
def bench(tmp_path: Path) -> Bench:
    return Bench(tmp_path)
