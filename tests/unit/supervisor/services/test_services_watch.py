"""Modules are restarted when their files change, and stay when the file is wrong."""

import os
from typing import Any

import pytest

from navette.cli.modules_watch import ChangeWatch
from navette.supervisor.project import find_project


class FakeClient:
    def __init__(self) -> None:
        self.restarted: list[list[str]] = []

    def restart(self, specs: Any, arguments: Any) -> None:
        self.restarted.append([spec.name for spec in specs])


def touch(path: Any) -> None:
    path.touch()
    os.utime(path, ns=(1, path.stat().st_mtime_ns + 1000))


def test_a_change_restarts_what_it_concerns(
    bench: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    one, both = bench.write("", "one.py"), bench.write("", "both.py")
    file = bench.write(
        "modules: {a: {nodes: [one.py, both.py]}, b: {nodes: [both.py]}}"
    )
    client = FakeClient()
    watch = ChangeWatch(
        client,  # type: ignore[arg-type]
        lambda: (find_project(bench.folder), bench.read(), []),
    )
    assert watch.described == "the files of a (2), b (1), and navette.yaml"
    watch.look()
    touch(one)
    watch.look()
    touch(both)
    watch.look()
    assert client.restarted == [["a"], ["a", "b"]]
    file.write_text("modules: {a: {nodes: [one.py]}, b: {nodes: [both.py]}}")
    touch(file)
    watch.look()
    assert client.restarted[2:] == [["a"]]
    file.write_text("modules: {a: {nodes: [gone.py]}}")
    touch(file)
    watch.look()
    assert client.restarted[3:] == []
    said = capsys.readouterr().err.split("\n")
    assert said[0] == "one.py changed: restarting a"
    assert said[2] == "navette.yaml changed: restarting a"
    assert said[3].startswith("nothing was restarted: ")
    assert "gone.py: no such file" in said[3]
