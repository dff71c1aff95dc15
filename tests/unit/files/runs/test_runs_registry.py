"""Registry of private runs: names, stale entries, hostile content."""

import json
import os
import stat
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from navette.errors import FileFormatError, InvalidValueError, NetworkError
from navette.files.runs import PrivateRun, RunInfo, live_runs, private_run
from navette.files.runs import folder as folder_module
from navette.files.runs.entry import MAX_BYTES, PROTOCOL, is_run_name
from navette.files.runs.folder import make_private

CLAIM = """
import sys
from navette.files.runs import PrivateRun
run = PrivateRun.claim("demo", world="hall")
run.publish("")
print(run.info.name, flush=True)
sys.stdin.read()
"""


def entry_of(run: PrivateRun) -> Path:
    return run.info.folder / "run.json"


def test_a_published_run_is_found_with_all_it_published(demo: PrivateRun) -> None:
    (found,) = live_runs()
    assert (found.name, found.command, found.world) == ("demo", "navette demo", "arena")
    assert (found.page, found.pid) == ("http://127.0.0.1:8765", os.getpid())
    assert found.router == demo.info.router
    assert found.start_ns > 0


def test_only_this_user_can_reach_folder_and_files(demo: PrivateRun) -> None:
    folder = demo.info.folder
    for each in (folder, folder.parent):
        assert stat.S_IMODE(each.stat().st_mode) == 0o700
    assert stat.S_IMODE((folder / "lock").stat().st_mode) == 0o600


def test_the_second_run_gets_a_number_and_the_first_name_becomes_free_again(
    demo: PrivateRun,
) -> None:
    second = PrivateRun.claim("demo")
    assert second.info.name == "demo-2"
    demo.close()
    third = PrivateRun.claim("demo")
    assert third.info.name == "demo"
    assert live_runs() == []  # neither is published yet
    second.close()
    third.close()


def test_runs_of_terminals_with_other_runtime_folders_have_other_names(
    monkeypatch: pytest.MonkeyPatch, runtime: Path
) -> None:
    own = f"navette-{os.getuid()}"
    monkeypatch.delenv("NAVETTE_RUNTIME_DIR")
    for name in ("a", "b"):
        (runtime / name).mkdir(mode=0o700)
    bases = [runtime / "a" / own, runtime / "b" / own]
    monkeypatch.setattr(folder_module, "_candidates", lambda: iter(bases))
    first = PrivateRun.claim("demo")
    first.publish("")
    bases.reverse()
    second = PrivateRun.claim("demo")
    assert second.info.folder.parent != first.info.folder.parent
    assert second.info.name == "demo-2"
    with pytest.raises(InvalidValueError, match="'demo' exists already"):
        PrivateRun.claim("demo", name="demo")
    first.close()
    second.close()


def test_a_named_run_is_refused_while_another_has_the_name(demo: PrivateRun) -> None:
    with pytest.raises(InvalidValueError, match=r"'demo' exists already \(runs: demo"):
        PrivateRun.claim("sim", name="demo")
    kitchen = PrivateRun.claim("sim", name="kitchen")
    assert kitchen.info.command == "navette sim"
    kitchen.close()


def test_closing_withdraws_the_entry_once(demo: PrivateRun) -> None:
    demo.close()
    assert live_runs() == []
    successor = PrivateRun.claim("demo")
    successor.publish("")
    demo.close()  # must not remove the successor's entry
    assert [run.name for run in live_runs()] == ["demo"]
    successor.close()


def test_a_killed_run_leaves_no_run_and_its_name_and_sockets_are_reused() -> None:
    with subprocess.Popen(
        [sys.executable, "-c", CLAIM],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "demo\n"
        (found,) = live_runs()
        assert found.pid == process.pid
        folder = found.folder
        process.kill()
    assert (folder / "run.json").is_file()  # its process could not remove it
    assert live_runs() == []
    for name in ("0a1b2c3d.sock", "0a1b2c3d.sock.lock"):
        (folder / name).touch()
    again = PrivateRun.claim("demo")
    assert again.info.folder == folder
    assert sorted(path.name for path in folder.iterdir()) == ["lock"]
    again.close()


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"", "not an entry"),
        (b"[" * 20_000, f"longer than {MAX_BYTES} bytes"),
        (b"[" * 15_000, "not an entry"),
        (b"\xff\xfe", "not UTF-8"),
        (b"[]", "no JSON object"),
        (b'{"protocol": true}', "protocol True: expected a whole number"),
        (b'{"protocol": 1e999}', "expected a whole number"),
        (b'{"protocol": -1}', "expected a whole number"),
    ],
)
def test_an_invalid_entry_is_reported_and_ignored(
    demo: PrivateRun, caplog: pytest.LogCaptureFixture, content: bytes, reason: str
) -> None:
    entry_of(demo).write_bytes(content)
    assert live_runs() == []
    assert reason in caplog.text


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("page", "javascript:alert(1)"),
        ("page", "http://127.0.0.1:1/\x1b[2J"),
        ("page", 7),
        ("world", "\x1b]0;title\x07"),
        ("world", "x" * 201),
        ("command", None),
        ("pid", -1),
        ("pid", "1"),
        ("pid", 2**31 + 1),
        ("domain", 233),
        ("navette", ["0.1.0"]),
    ],
)
def test_an_entry_with_a_hostile_value_is_ignored(
    demo: PrivateRun, caplog: pytest.LogCaptureFixture, key: str, value: object
) -> None:
    record = json.loads(demo.info.to_json())
    entry_of(demo).write_text(json.dumps({**record, key: value}))
    assert live_runs() == []
    assert f"{key} {value!r}"[:60] in caplog.text


def test_an_entry_cannot_choose_its_name_or_its_endpoints(demo: PrivateRun) -> None:
    record = json.loads(demo.info.to_json())
    hostile = {**record, "name": "other", "folder": "/x", "router": "tcp/6.6.6.6:1"}
    entry_of(demo).write_text(json.dumps(hostile))
    (found,) = live_runs()
    assert found.name == "demo"
    assert found.router == demo.info.router


@pytest.mark.parametrize("kind", ["link", "pipe", "folder"])
def test_an_entry_that_is_not_a_file_is_ignored(
    demo: PrivateRun, caplog: pytest.LogCaptureFixture, kind: str, tmp_path: Path
) -> None:
    entry = entry_of(demo)
    target = entry.rename(tmp_path / "elsewhere.json")
    if kind == "link":
        entry.symlink_to(target)
    elif kind == "pipe":
        os.mkfifo(entry)  # reading it would block for ever
    else:
        entry.mkdir()
    assert live_runs() == []
    assert "a run is ignored" in caplog.text
    if kind == "folder":
        entry.rmdir()


def test_of_another_protocol_only_the_common_values_are_read() -> None:
    text = json.dumps({"protocol": PROTOCOL + 1, "pid": 7, "navette": "9.1", "x": [1]})
    found = RunInfo.from_json(text, Path("/run/demo"))
    assert not found.is_compatible
    assert (found.name, found.pid, found.navette) == ("demo", 7, "9.1")
    assert found.row()[1] == "started by Navette 9.1"


# Written by `navette demo` of 22 November 2026.
RECORDED = """{"name": "demo", "command": "navette demo", "world": "arena", "pid": 7,
"domain": 0, "page": "http://127.0.0.1:8765", "navette": "0.1.0", "protocol": 1}"""


@pytest.mark.parametrize("more", [{}, {"robot": "jackal", "started": [1, 2]}])
def test_an_entry_of_another_version_with_the_same_protocol_is_read(
    more: dict[str, object],
) -> None:
    """A change that fails here needs a new protocol number."""
    text = json.dumps({**json.loads(RECORDED), **more})
    found = RunInfo.from_json(text, Path("/run/demo"))
    assert found.is_compatible
    assert found.row() == (
        "demo",
        "navette demo",
        "arena",
        "http://127.0.0.1:8765",
        "7",
    )
    assert set(json.loads(found.to_json())) == set(json.loads(RECORDED))
    assert found.router == "unixsock-stream//run/demo/router.sock"


def test_a_world_with_control_characters_is_published_without_them() -> None:
    run = PrivateRun.claim("sim", world="a\x1b[2Jb" + "c" * 300)
    run.publish("")
    (found,) = live_runs()
    assert found.world.startswith("a?[2Jbccc")
    run.close()


@pytest.mark.parametrize(
    "name", ["", ".", "..", "a/b", "-x", "A", "ä", "a" * 25, "a b"]
)
def test_these_names_are_refused(name: str) -> None:
    assert not is_run_name(name)


def test_a_run_without_a_private_folder_is_an_error(
    monkeypatch: pytest.MonkeyPatch, runtime: Path
) -> None:
    runtime.chmod(0o755)
    with pytest.raises(NetworkError, match="accessible to other users"):
        PrivateRun.claim("demo")
    assert live_runs() == []
    monkeypatch.setenv("NAVETTE_RUNTIME_DIR", str(runtime / "no" / "such"))
    with pytest.raises(NetworkError, match="cannot create: No such file"):
        PrivateRun.claim("demo")
    monkeypatch.setenv("NAVETTE_RUNTIME_DIR", f"/tmp/{'long' * 30}")
    with pytest.raises(NetworkError, match="NAVETTE_RUNTIME_DIR to a short path"):
        PrivateRun.claim("demo")
    runtime.chmod(0o700)


def test_a_file_in_place_of_the_folder_is_an_error(runtime: Path) -> None:
    (runtime / "runs").touch()
    with pytest.raises(FileFormatError, match="cannot create"):
        make_private(runtime / "runs")


def test_claims_at_the_same_instant_in_two_folders_get_two_names(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    folders = [tmp_path / "a", tmp_path / "b"]
    for folder in folders:
        make_private(folder)
        make_private(folder / "runs")
    monkeypatch.setattr(private_run, "existing_folders", lambda: folders)
    monkeypatch.setattr(private_run, "live_runs", list)  # neither is published yet
    own = threading.local()
    monkeypatch.setattr(private_run, "runtime_folder", lambda longest: own.folder)
    barrier = threading.Barrier(2)

    def claim(folder: Path) -> PrivateRun:
        own.folder = folder
        barrier.wait()
        return PrivateRun.claim("demo")

    with ThreadPoolExecutor(2) as threads:
        for _ in range(20):
            runs = list(threads.map(claim, folders))
            assert sorted(run.info.name for run in runs) == ["demo", "demo-2"]
            for run in runs:
                run.close()


def test_a_run_that_is_not_published_yet_keeps_its_name_from_other_folders(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    for name in ("a", "b"):
        make_private(tmp_path / name)
    folders = [tmp_path / "a", tmp_path / "b"]
    monkeypatch.setattr(private_run, "existing_folders", lambda: folders)
    for first, second in (("a", "b"), ("b", "a")):
        monkeypatch.setattr(private_run, "runtime_folder", lambda n: tmp_path / first)  # noqa: B023 - replaced in each round
        run = PrivateRun.claim("demo")
        monkeypatch.setattr(private_run, "runtime_folder", lambda n: tmp_path / second)  # noqa: B023 - replaced in each round
        with pytest.raises(InvalidValueError, match="'demo' exists already"):
            PrivateRun.claim("demo", name="demo")
        run.close()
