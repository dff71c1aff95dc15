"""The log, and requests to a supervisor."""

import socket
from pathlib import Path
from typing import Any

import pytest

from navette.runtime.clock import VirtualClock
from navette.supervisor import log_store
from navette.supervisor.client import SupervisorClient, SupervisorError
from navette.supervisor.log_store import LogLine, LogReader, LogStore
from navette.supervisor.project import Project, socket_path
from navette.supervisor.status import projects_in_same_domain


def texts(lines: list[LogLine]) -> list[str]:
    return [line.text for line in lines]


def test_the_log_is_read_in_order_while_it_is_written(tmp_path: Path) -> None:
    reader = LogReader(tmp_path, accept=lambda line: line.service == "a")
    assert reader.last(None) == []
    book = LogStore(tmp_path, VirtualClock(7))
    book.write("a", "x", ["one", "two"])
    book.write("b", "b", ["other"])
    assert texts(reader.last(1)) == ["two"]
    book.write("a", "x", ["three"], event=True)
    assert reader.new() == [LogLine(7, "a", "x", "three", True)]
    assert reader.new() == []
    assert reader.last(0) == []
    reader.close()
    book.close()
    book.write("a", "x", ["after the end"])
    assert LogLine(0, "b", "b", "").label == "b"


def test_rotation_loses_no_new_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(log_store, "_MAX_BYTES", 1000)
    book, reader = LogStore(tmp_path, VirtualClock()), LogReader(tmp_path)
    found = []
    for number in range(100):
        book.write("a", "x", [str(number)])
        found += texts(reader.new())
    assert found == [str(number) for number in range(100)]
    assert sum(file.stat().st_size for file in tmp_path.iterdir()) < 2500
    late = LogReader(tmp_path)
    assert texts(late.last(3)) == ["97", "98", "99"]
    late.close()
    reader.close()
    book.close()


def test_incomplete_lines_are_skipped(tmp_path: Path) -> None:
    (tmp_path / log_store.FILE_NAME).write_bytes(b'{"t": 1, "mod\n[1]\n\xff\n')
    reader = LogReader(tmp_path)
    assert reader.last(None) == []
    reader.close()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="Linux: /dev/full")
def test_a_full_disk_loses_lines_only(tmp_path: Path) -> None:
    book, reader = LogStore(tmp_path, VirtualClock()), LogReader(tmp_path)
    book.write("a", "x", ["before"])
    usual = book._file
    with Path("/dev/full").open("wb", buffering=0) as full:
        book._file = full
        book.write("a", "x", ["one", "two"])
        book.write("a", "x", ["three"])
    assert book.problem == "No space left on device"
    usual.write(b'{"t": 0, "incomp')  # what fitted
    book._file = usual
    book.write("a", "x", ["after"])
    assert book.problem == ""
    assert texts(reader.last(None)) == [
        "before",
        "3 lines are not in the log: No space left on device",
        "after",
    ]
    reader.close()
    book.close()


def test_a_hanging_supervisor_is_a_timeout(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NAVETTE_STATE_DIR", str(tmp_path))
    client = SupervisorClient(Project(tmp_path))
    monkeypatch.setattr("navette.supervisor.client._TIMEOUT_S", 0.05)
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as silent:
        silent.bind(str(socket_path(client.project.state)))
        silent.listen()
        with pytest.raises(SupervisorError, match="does not respond"):
            client.down(None)
        Path(silent.getsockname()).unlink()


class FakeClient(SupervisorClient):
    """A client of a project with a process in each domain."""

    def __init__(self, folder: str, *domains: str) -> None:
        super().__init__(Project(Path(folder)))
        self._domains = domains

    def status(self) -> list[dict[str, Any]]:
        process = {
            "name": "p",
            "label": "p",
            "state": "running",
            "pid": 1,
            "seconds": 0.0,
            "restarts": 0,
            "reason": "",
        }
        found = [{**process, "domain": domain} for domain in self._domains]
        return [{"service": "p", "processes": found}]


def test_projects_in_the_same_domain_are_found() -> None:
    own = FakeClient("/a", "0", "7")
    others = [own, FakeClient("/b", "7", "7", "8"), FakeClient("/c", "9")]
    assert projects_in_same_domain(own, others) == [("7", Project(Path("/b")))]
