"""Every fuzz test runs with bounded memory, in a folder of its own."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from fuzz.limits import HANG_S, SECONDS, limited_memory


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Long runs end by NAVETTE_FUZZ_SECONDS; each input has its own bound."""
    if SECONDS:
        for item in items:
            if Path(__file__).parent in item.path.parents:
                item.add_marker(pytest.mark.timeout(SECONDS + 2 * HANG_S))


@pytest.fixture(autouse=True)
def _bounded_memory() -> Iterator[None]:
    with limited_memory():
        yield


@pytest.fixture(autouse=True)
def _own_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Services may write files with relative names."""
    monkeypatch.chdir(tmp_path)
