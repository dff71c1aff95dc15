"""The import hook is installed for each test here, and gone after it."""

from collections.abc import Iterator

import pytest

from navette.ros2 import names as interop


@pytest.fixture(autouse=True)
def hook() -> Iterator[None]:
    interop.install()
    yield
    interop.uninstall()
