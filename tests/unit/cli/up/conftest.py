"""A project whose supervisor stores its state in a temporary folder."""

import os
import select
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from navette.cli.up.config import read_config
from navette.supervisor.client import SupervisorClient
from navette.supervisor.project import find_project
from navette.supervisor.status import (
    ProcessStatus,
    process_statuses,
    until_down,
    until_settled,
)

WAIT_S = 60.0


class Bench:
    """A project folder with the commands of a user."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def write(self, text: str, name: str = "navette.yaml") -> Path:
        path = self.folder / name
        path.write_text(text)
        return path

    def read(self, **arguments: str) -> Any:
        return read_config(find_project(self.folder), arguments)

    def specs(self, *names: str, **arguments: str) -> Any:
        content = self.read(**arguments)
        return content.specs(names or content.names)

    @property
    def client(self) -> SupervisorClient:
        return SupervisorClient(find_project(self.folder))

    def up(self, *names: str) -> dict[str, ProcessStatus]:
        specs = self.specs(*names)
        self.client.up(specs, {})
        return self.settled(*[spec.name for spec in specs])

    def settled(self, *names: str) -> dict[str, ProcessStatus]:
        *_, found = until_settled(self.client, names, WAIT_S)
        assert all(view.is_settled for view in found), found
        return {view.label: view for view in found}

    def down(self, *names: str) -> None:
        self.client.down(names or None)
        *_, _ = until_down(self.client, names or None, WAIT_S)
        left = {each.service for each in process_statuses(self.client.status())}
        assert not left & set(names) if names else not left


@pytest.fixture
def bench(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Bench]:
    monkeypatch.setenv("NAVETTE_STATE_DIR", str(tmp_path / "state"))
    # Sockets need short paths.
    run = tempfile.TemporaryDirectory(prefix="navette-test-")
    monkeypatch.setenv("XDG_RUNTIME_DIR", run.name)
    monkeypatch.setenv("NAVETTE_TRANSPORT", "inprocess")
    folder = tmp_path / "project"
    folder.mkdir()
    monkeypatch.chdir(folder)
    made = Bench(folder)
    yield made
    if made.client.is_reachable():
        made.down()
    run.cleanup()


def read_bounded(pipe: int, size: int = 1) -> bytes:
    """What comes next through a pipe, or its end."""
    ready, _, _ = select.select([pipe], [], [], WAIT_S)
    assert ready, "nothing came, and it did not end"
    return os.read(pipe, size)
