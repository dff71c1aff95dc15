"""A registry of its own for each test, and an environment that names no network."""

from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from navette.files.runs import PrivateRun
from navette.files.runs.choice import NETWORK_VARIABLES, VARIABLE


@pytest.fixture(autouse=True)
def runtime(monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Return the user's runtime folder; a short path, as sockets need one."""
    for name in (*NETWORK_VARIABLES, VARIABLE):
        monkeypatch.delenv(name, raising=False)
    with TemporaryDirectory(prefix="nv-") as folder:
        monkeypatch.setenv("NAVETTE_RUNTIME_DIR", folder)
        yield Path(folder)


@pytest.fixture
def demo() -> Iterator[PrivateRun]:
    """Return a published run of this process."""
    run = PrivateRun.claim("demo", world="arena")
    run.publish("http://127.0.0.1:8765")
    yield run
    run.close()
