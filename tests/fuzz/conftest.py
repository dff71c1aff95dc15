"""Every fuzz test runs with bounded memory, in a folder of its own."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from fuzz.limits import limited_memory


@pytest.fixture(autouse=True)
def _bounded_memory() -> Iterator[None]:
    with limited_memory():
        yield


@pytest.fixture(autouse=True)
def _own_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Services may write files with relative names."""
    monkeypatch.chdir(tmp_path)
