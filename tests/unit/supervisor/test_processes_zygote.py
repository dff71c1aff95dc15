"""Programs of Navette as children of a zygote: the same as processes of their own."""

import json
import os
import signal
import sys
from pathlib import Path

import pytest
from process_bench import Bench, Heard

from navette.supervisor import ChildProcess, StartOptions
from navette.supervisor.forking import Wish, _Link

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform != "linux", reason="only Linux has zygotes"),
]

TELL = """
import json, os, signal, sys
print(json.dumps({
    "argv": sys.argv, "cwd": os.getcwd(), "a": os.environ.get("A"),
    "home": os.environ.get("HOME"), "sid": os.getsid(0), "pgid": os.getpgrp(),
    "pid": os.getpid(), "parent": os.getppid(),
    "random": __import__("random").random(),
    "numpy": __import__("numpy").random.random(),
    "path": sys.path[:2], "main": __name__,
    "sigint": signal.getsignal(signal.SIGINT) is signal.default_int_handler,
    "tty": sys.stdin.isatty(), "fds": sorted(map(int, os.listdir("/proc/self/fd"))),
    "blocked": sorted(signal.pthread_sigmask(signal.SIG_BLOCK, [])),
    "words": open("/proc/self/cmdline").read().rstrip(chr(0)).split(chr(0)),
}))
sys.stderr.write(sys.stdin.readline())
print("ready")
"""
WAIT = "import signal, sys\nprint('ready', flush=True)\nsignal.pause()\n"
HEAD = (sys.executable, "-u", "-m", "navette", "run")


class Programs:
    """Starts programs of ``navette run`` under one keeper."""

    def __init__(self, bench: Bench, folder: Path) -> None:
        self.bench = bench
        self.folder = folder

    def start(
        self,
        code: str,
        *args: str,
        env: dict[str, str] | None = None,
        **options: object,
    ) -> tuple[ChildProcess, Heard]:
        file = self.folder / "program.py"
        if not file.exists() or file.read_text() != code:
            file.write_text(code)
        heard = Heard()
        made = StartOptions(env={**os.environ, **(env or {})}, **options)  # type: ignore[arg-type]
        return self.bench.keeper.start([*HEAD, str(file), *args], heard, made), heard

    def tell(self, *args: str, **options: object) -> dict[str, object]:
        """What a process finds."""
        running, heard = self.start(TELL, *args, **options)  # type: ignore[arg-type]
        running.write(b"hello\n")
        assert heard.wait_over() == 0, heard.text
        assert heard.text["stderr"] == b"hello\n"
        found: dict[str, object] = json.loads(heard.text["stdout"].splitlines()[0])
        return found


@pytest.fixture
def programs(bench: Bench, tmp_path: Path) -> Programs:
    return Programs(bench, tmp_path)


def parent_of(pid: int) -> int:
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return int(fields[1])


def test_a_child_finds_what_a_process_of_its_own_finds(programs: Programs) -> None:
    folder = programs.folder / "there"
    folder.mkdir()
    forked, alone = (
        programs.tell("x", "ä b", cwd=str(folder), env={"A": "b", **more})
        for more in ({}, {"NAVETTE_ZYGOTE": "0"})
    )
    for differs in ("random", "numpy"):
        assert forked.pop(differs) != alone.pop(differs)
    for found in (forked, alone):
        pid = found.pop("pid")
        assert found.pop("sid") == pid == found.pop("pgid")
    assert forked.pop("parent") != os.getpid() == alone.pop("parent")
    assert forked == alone


def test_two_children_differ_in_what_is_drawn(programs: Programs) -> None:
    first, second = programs.tell(), programs.tell()
    assert first["parent"] == second["parent"]
    assert first["numpy"] != second["numpy"]
    assert first["random"] != second["random"]


@pytest.mark.parametrize(
    ("number", "code"),
    [(signal.SIGINT, 130), (signal.SIGTERM, -15), (signal.SIGKILL, -9)],
)
def test_signals_and_exit_codes(programs: Programs, number: int, code: int) -> None:
    plain = "import signal; signal.signal(signal.SIGTERM, signal.SIG_DFL)\n"
    running, heard = programs.start(plain + WAIT)
    heard.wait_ready()
    running.signal(number)
    assert heard.wait_over() == code
    running.signal(number)  # it is over: nothing happens


def test_code_of_its_own_and_errors_in_the_output(programs: Programs) -> None:
    code = "import sys\nprint(1)\nsys.stderr.write('2\\n')\nprint('ready')\nsys.exit(3)"
    _, heard = programs.start(code, one_stream=True)
    assert heard.wait_over() == 3
    assert heard.text == {"stdout": b"1\n2\nready\n", "stderr": b""}


def test_descriptors_keep_their_numbers(programs: Programs) -> None:
    read, write = os.pipe()
    code = "import os, sys\nos.write(int(sys.argv[1]), b'here')\nprint('ready')"
    _, heard = programs.start(code, str(write), pass_fds=(write,))
    assert heard.wait_over() == 0, heard.text
    os.close(write)
    with os.fdopen(read, "rb") as file:
        assert file.read() == b"here"


def test_another_environment_of_python_is_another_process(programs: Programs) -> None:
    assert programs.tell()["parent"] != os.getpid()
    assert programs.tell(env={"PYTHONHASHSEED": "1"})["parent"] == os.getpid()


def test_what_was_changed_is_read_anew(programs: Programs) -> None:
    """A folder of modules, as Navette's own: a new zygote takes over."""
    modules = programs.folder / "modules"
    modules.mkdir()
    env = {"PYTHONPATH": str(modules), "PYTHONDONTWRITEBYTECODE": "1"}
    running, heard = programs.start(WAIT, env=env)
    heard.wait_ready()
    (modules / "new.py").write_text("")
    second = programs.tell(env=env)
    assert second["parent"] not in (os.getpid(), parent_of(running.pid))
    running.signal(signal.SIGKILL)
    assert heard.wait_over() == -9


def test_a_killed_zygote_takes_its_children_along(programs: Programs) -> None:
    """Nobody could wait for them; the next one starts under another."""
    running, heard = programs.start(WAIT)
    heard.wait_ready()
    zygote = parent_of(running.pid)
    os.kill(zygote, signal.SIGKILL)
    assert heard.wait_over() == -9
    assert programs.tell()["parent"] not in (os.getpid(), zygote)


def test_a_zygote_that_dies_before_it_reads_starts_nothing() -> None:
    gone: list[int] = []
    link = _Link(dict(os.environ), gone.append)
    os.kill(link.pid, signal.SIGSTOP)
    link._control.sendall(b"unread")
    os.kill(link.pid, signal.SIGKILL)
    link.thread.join(20.0)
    assert gone == [link.pid]
    assert link.start(Wish((), {}, None, False, ())) is None


def test_closing_ends_the_children_and_the_zygote(programs: Programs) -> None:
    running, heard = programs.start(WAIT)
    heard.wait_ready()
    zygote = parent_of(running.pid)
    programs.bench.keeper.close()
    assert heard.wait_over() == 130
    assert not Path(f"/proc/{zygote}").exists()
