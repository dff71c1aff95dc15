"""Fixture of these tests: the import hook is installed during each of them."""

from collections.abc import Iterator

import pytest

from navette.ros2 import names


@pytest.fixture(autouse=True)
def hook() -> Iterator[None]:
    names.install()
    yield
    names.uninstall()
