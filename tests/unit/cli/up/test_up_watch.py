"""Services restart when their files change, except if navette.yaml is invalid."""

import os
from pathlib import Path
from typing import Any

import pytest

from navette.cli.up.watch import FileWatch, ServiceWatch


class FakeClient:
    def __init__(self) -> None:
        self.restarted: list[list[str]] = []

    def restart(self, specs: Any, arguments: Any) -> None:
        self.restarted.append([spec.name for spec in specs])


def touch(path: Any) -> None:
    path.touch()
    os.utime(path, ns=(1, path.stat().st_mtime_ns + 1000))


def test_a_change_restarts_the_affected_services(
    bench: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    one, both = bench.write("", "one.py"), bench.write("", "both.py")
    file = bench.write(
        "services: {a: {nodes: [one.py, both.py]}, b: {nodes: [both.py]}}"
    )
    client = FakeClient()
    watch = ServiceWatch(
        client,  # type: ignore[arg-type]
        read=lambda: (bench.read(), []),
    )
    assert watch.describe() == "the files of a (2), b (1), and navette.yaml"
    watch.poll()
    touch(one)
    watch.poll()
    touch(both)
    watch.poll()
    assert client.restarted == [["a"], ["a", "b"]]
    file.write_text("services: {a: {nodes: [one.py]}, b: {nodes: [both.py]}}")
    touch(file)
    watch.poll()
    assert client.restarted[2:] == [["a"]]
    file.write_text("services: {a: {nodes: [gone.py]}}")
    touch(file)
    watch.poll()
    assert client.restarted[3:] == []
    messages = capsys.readouterr().err.split("\n")
    assert messages[0] == "one.py changed: restarting a"
    assert messages[2] == "navette.yaml changed: restarting a"
    assert messages[3].startswith("nothing was restarted: ")
    assert "gone.py: no such file" in messages[3]


def test_changed_files_are_found(tmp_path: Path) -> None:
    folder = tmp_path / "package"
    (folder / "__pycache__").mkdir(parents=True)
    node = folder / "node.py"
    node.write_text("1")
    watch = FileWatch([folder, tmp_path / "single.yaml"])
    assert watch.count == 1
    assert watch.changed() == []
    os.utime(node, ns=(1, 1))
    assert watch.changed() == [node]
    (folder / "__pycache__" / "node.pyc").touch()
    (folder / "notes.txt").touch()
    (folder / ".hidden.py").touch()
    assert watch.changed() == []
    (tmp_path / "single.yaml").touch()
    node.unlink()
    assert watch.changed() == [node, tmp_path / "single.yaml"]
    assert watch.changed() == []


def test_the_number_of_files_is_limited(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("navette.cli.up.watch._MAX_FILES", 3)
    for number in range(9):
        (tmp_path / f"{number}.py").touch()
    assert FileWatch([tmp_path, tmp_path / "nowhere"]).count == 3
