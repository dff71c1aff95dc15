"""Compiled kernels on disk: read-only folders, damaged, stale and foreign files."""

import ast
import importlib
import inspect
import json
import os
import pickle
import re
import subprocess
import sys
import textwrap
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest
from numba.core.dispatcher import Dispatcher

import navette
from mounts import needs_mounts, read_only, small
from navette.files import kernels

pytestmark = pytest.mark.long

PROGRAM = """
import json, sys
from caller import area, Size
print(json.dumps([area(Size(2.0, 3.0)), sum(area.stats.cache_hits.values())]))
"""
CALLER = """
from navette.files.kernels import kernel
from callee import product
from sizes import Size

@kernel
def area(size):
    return product(size.width, size.height)
"""
CALLEE = """
from navette.files.kernels import kernel
FACTOR = 1

@kernel
def product(a, b):
    return FACTOR * a * b
"""
SIZES = """
from typing import NamedTuple

class Size(NamedTuple):
    width: float
    height: float
"""


class Bench:
    """A program with two kernels, in two files, and its cache folder."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.home = folder / "home"
        self.temporary = folder / "temporary"
        for each in (self.home, self.temporary):
            each.mkdir()
        self.cache = self.home / ".cache" / "navette" / "kernels"
        files = {"program": PROGRAM, "caller": CALLER, "callee": CALLEE, "sizes": SIZES}
        for name, text in files.items():
            (folder / f"{name}.py").write_text(text)

    def run(self) -> tuple[float, int]:
        """Import the kernels as a new process would; return the area and cache hits."""
        for name in ("caller", "callee", "sizes", "moved"):
            sys.modules.pop(name, None)
        importlib.invalidate_caches()
        kernels._folder.cache_clear()
        caller = importlib.import_module("caller")  # noqa: TID251 - of the test
        area = caller.area(caller.Size(2.0, 3.0))
        return area, sum(caller.area.stats.cache_hits.values())

    def edit(self, file: str, old: str, new: str) -> None:
        path = self.folder / file
        path.write_text(path.read_text().replace(old, new))

    @property
    def command(self) -> list[str]:
        return [sys.executable, str(self.folder / "program.py")]

    def start(self, command: Sequence[str]) -> tuple[float, int, list[str]]:
        """Run a process; return the area, hits in the cache, and lines on stderr."""
        done = subprocess.run(command, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        area, hits = json.loads(done.stdout)
        return area, hits, done.stderr.splitlines()

    def files(self) -> dict[str, bytes]:
        return {path.name: path.read_bytes() for path in self.cache.iterdir()}


@pytest.fixture
def bench(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Bench]:
    bench = Bench(tmp_path)
    monkeypatch.setenv("HOME", str(bench.home))
    monkeypatch.setenv("TMPDIR", str(bench.temporary))
    monkeypatch.setattr("tempfile.tempdir", None)
    monkeypatch.setattr("sys.dont_write_bytecode", True)
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    monkeypatch.syspath_prepend(tmp_path)
    yield bench
    kernels._folder.cache_clear()


def test_the_second_process_loads_what_the_first_compiled(bench: Bench) -> None:
    assert bench.start(bench.command) == (6.0, 0, [])
    before = bench.files()
    assert bench.start(bench.command) == (6.0, 1, [])
    assert bench.files() == before
    assert len(before) == 2


@needs_mounts
def test_a_read_only_home_leaves_a_temporary_cache(bench: Bench) -> None:
    command = read_only([bench.home], bench.command)
    area, hits, lines = bench.start(command)
    assert (area, hits, len(lines)) == (6.0, 0, 1)
    assert "Read-only file system" in lines[0]
    assert str(bench.temporary) in lines[0]
    assert "XDG_CACHE_HOME" in lines[0]
    area, hits, lines = bench.start(command)
    assert (area, hits, len(lines)) == (6.0, 1, 1)


@needs_mounts
def test_without_a_writable_folder_kernels_are_compiled(bench: Bench) -> None:
    # Python itself takes the current folder for temporary files if no other is left.
    folders = [bench.home, Path("/tmp"), Path("/var/tmp"), Path("/usr/tmp"), Path.cwd()]
    existing = [folder for folder in folders if folder.is_dir()]
    for _ in range(2):
        area, hits, lines = bench.start(read_only(existing, bench.command))
        assert (area, hits, len(lines)) == (6.0, 0, 1)
        assert "each start takes longer" in lines[0]


@needs_mounts
def test_a_full_disk_costs_only_the_cache(bench: Bench) -> None:
    area, _, lines = bench.start(small(bench.home, "4k", bench.command))
    assert area == 6.0
    assert len(lines) == 1
    assert "No space left on device" in lines[0]


def _flip(content: bytes) -> bytes:
    middle = len(content) // 2
    return content[:middle] + bytes([content[middle] ^ 1]) + content[middle + 1 :]


@pytest.mark.parametrize(
    "damage",
    [lambda content: b"", lambda content: content[:-1], lambda content: b"x", _flip],
    ids=["empty", "truncated", "replaced", "one bit"],
)
def test_damaged_files_are_made_again(
    bench: Bench, damage: Callable[[bytes], bytes]
) -> None:
    bench.run()
    names = bench.files().keys()
    for path in bench.cache.iterdir():
        path.write_bytes(damage(path.read_bytes()))
    assert bench.run() == (6.0, 0)
    assert bench.files().keys() == names
    assert bench.run() == (6.0, 1)


def test_classes_may_move_between_versions(bench: Bench) -> None:
    bench.run()
    (bench.folder / "sizes.py").rename(bench.folder / "moved.py")
    bench.edit("caller.py", "from sizes", "from moved")
    assert bench.run() == (6.0, 0)
    assert bench.run() == (6.0, 1)


def test_a_file_with_a_class_that_is_gone_is_made_again(bench: Bench) -> None:
    bench.run()
    for path in bench.cache.iterdir():
        kernels._write(path, b"cmodule_that_is_gone\nSize\n.")
    assert bench.run() == (6.0, 0)
    assert bench.run() == (6.0, 1)


@pytest.mark.parametrize(
    ("file", "old", "new", "area"),
    [
        ("callee.py", "FACTOR * a * b", "FACTOR * a + b", 5.0),
        ("callee.py", "FACTOR = 1", "FACTOR = 7", 42.0),
        ("caller.py", "size.height", "1.0", 2.0),
    ],
)
def test_changed_sources_are_compiled_again(
    bench: Bench, file: str, old: str, new: str, area: float
) -> None:
    bench.run()
    bench.edit(file, old, new)
    assert bench.run() == (area, 0)


def test_the_order_of_fields_is_part_of_a_type(bench: Bench) -> None:
    bench.edit("caller.py", "size.height", "1.0")
    assert bench.run() == (2.0, 0)
    (bench.folder / "sizes.py").write_text(
        "from typing import NamedTuple\n"
        "class Size(NamedTuple):\n    height: float\n    width: float\n"
    )
    assert bench.run() == (3.0, 0)


class _Marker:
    """Unpickled, it creates a file."""

    def __init__(self, path: Path) -> None:
        self._path = path

    def __reduce__(self) -> tuple[Any, ...]:
        return os.mkdir, (str(self._path),)


@pytest.mark.parametrize("mode", [0o660, 0o602])
def test_files_that_others_can_write_are_not_read(bench: Bench, mode: int) -> None:
    bench.run()
    marker = bench.folder / "marker"
    for path in bench.cache.iterdir():
        kernels._write(path, pickle.dumps(_Marker(marker)))
        path.chmod(mode)
    assert bench.run() == (6.0, 0)
    assert not marker.exists()


def test_a_folder_that_others_can_write_is_not_used(
    bench: Bench, caplog: pytest.LogCaptureFixture
) -> None:
    bench.run()
    marker = bench.folder / "marker"
    for path in bench.cache.iterdir():
        kernels._write(path, pickle.dumps(_Marker(marker)))
    bench.cache.chmod(0o777)
    assert bench.run() == (6.0, 0)
    assert f"other users can write {bench.cache}" in caplog.text
    assert not marker.exists()


def test_files_are_not_exchanged(bench: Bench) -> None:
    bench.run()
    one, other = bench.cache.iterdir()
    swap = bench.cache / "swap"
    one.rename(swap)
    other.rename(one)
    swap.rename(other)
    assert bench.run() == (6.0, 0)


def test_processes_share_the_cache(bench: Bench) -> None:
    running = [
        subprocess.Popen(
            bench.command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )
        for _ in range(3)
    ]
    for process in running:
        assert json.loads(process.communicate()[0])[0] == 6.0
    assert len(bench.files()) == 2


def test_unused_files_are_deleted(bench: Bench) -> None:
    bench.run()
    before = set(bench.files())
    for name in before:
        os.utime(bench.cache / name, (0, 0))
    assert bench.run() == (6.0, 1)  # used again
    os.utime(bench.cache / min(before), (0, 0))
    bench.edit("caller.py", "size.height", "1.0")
    bench.run()
    assert min(before) not in bench.files()


def test_the_user_may_choose_the_folder(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(bench.folder / "chosen"))
    assert bench.run() == (6.0, 0)
    assert len(list((bench.folder / "chosen" / "navette" / "kernels").iterdir())) == 2
    assert not bench.cache.exists()


def test_kernels_may_run_as_python(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("numba.config.DISABLE_JIT", 1)

    def double(x: float) -> float:
        return 2 * x

    assert kernels.kernel(double) is double


def test_globals_of_kernels_are_numbers_modules_or_kernels() -> None:
    @kernels.kernel
    def wrong() -> int:
        return len(TABLE)

    with pytest.raises(TypeError, match="wrong: TABLE is a dict"):
        wrong()


TABLE = {1: 2}


def _kernels_of_navette() -> Iterator[Any]:
    package = Path(navette.__file__).parent
    for path in package.rglob("*.py"):
        if "import kernel\n" not in path.read_text():
            continue
        name = ".".join(path.relative_to(package.parent).with_suffix("").parts)
        module = importlib.import_module(name)  # noqa: TID251 - all that have kernels
        for each in vars(module).values():
            if isinstance(each, Dispatcher):
                yield each


def test_every_kernel_of_navette_can_be_stored() -> None:
    found = 0
    for each in _kernels_of_navette():
        assert isinstance(each._cache, kernels.KernelCache)
        assert kernels._describe_function(each.py_func)
        found += 1
    assert found > 80


def test_kernels_that_count_no_references_return_no_arrays() -> None:
    """The caller would release an array that it was not given."""
    unsigned = {"np.uint32", "np.uint64", "numpy.uint32", "numpy.uint64"}
    numbers = {"None", "float", "int", "bool", "class"} | unsigned
    found = 0
    for each in _kernels_of_navette():
        if each.targetoptions.get("_nrt", True):
            continue
        returned = str(each.py_func.__annotations__["return"])
        parts = set(re.findall(r"[\w.]+", returned.removeprefix("tuple")))
        assert parts <= numbers, f"{each.py_func.__name__} returns {returned}"
        found += 1
    assert found > 20


def test_no_kernel_uses_what_numba_implements_with_scipy() -> None:
    """SciPy is not installed with Navette."""
    with_scipy = {"linalg", "dot", "vdot", "median", "percentile", "searchsorted"}
    for each in _kernels_of_navette():
        source = ast.parse(textwrap.dedent(inspect.getsource(each.py_func)))
        for node in ast.walk(source):
            where = f"{each.py_func.__module__}.{each.py_func.__name__}"
            assert not isinstance(node, ast.MatMult), f"{where} has a product @"
            if isinstance(node, ast.Attribute):
                assert node.attr not in with_scipy, f"{where} uses {node.attr}"


DRIVE = """
import math, sys
from navette.navigation.stack import RunOptions
from navette.navigation.stack.simulation import Simulation

simulation = Simulation(RunOptions(goals=((2.0, 1.0),), headless=True, speed=math.inf))
simulation.executor.spin_for(4_000_000_000)
simulation.close()
compiler = ("scipy.linalg", "numba.np.arrayobj", "numba.cpython.unicode")
print([name for name in compiler if name in sys.modules])
"""


def test_a_drive_with_stored_kernels_does_not_import_what_compiles_them() -> None:
    """Of linear algebra for ``np.median``, ``np.searchsorted`` and the like."""
    command = [sys.executable, "-c", DRIVE]
    subprocess.check_output(command)  # compiles what is not stored
    assert subprocess.check_output(command, text=True) == "[]\n"
