"""Kernels in the package: used as they are, and compiled if anything differs."""

import importlib
import os
import pickle
import subprocess
import sys
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from navette.files import kernel_archive, kernels
from navette.files.kernel_archive import GenericProcessor, archive_path, write_archive

KERNEL = """
from navette.files.kernels import kernel
FACTOR = 2.0

@kernel
def scaled(x):
    return FACTOR * x
"""
RESULT = 6.0


class Package:
    """A module with a kernel, its archive, and the user's cache."""

    def __init__(self, folder: Path) -> None:
        self.module = folder / "scaling.py"
        self.module.write_text(KERNEL)
        self.compiled = folder / "compiled"
        self.cache = folder / "cache"

    def run(self) -> tuple[float, str]:
        """Call the kernel in a new dispatcher; return its result and its origin."""
        sys.modules.pop("scaling", None)
        importlib.invalidate_caches()
        kernels._folder.cache_clear()
        kernel_archive.select_processor.cache_clear()
        kernel_archive.package_archive.cache_clear()
        before = self.stored()
        scaled = importlib.import_module("scaling").scaled  # noqa: TID251 - of the test
        result = scaled(3.0)
        is_loaded = sum(scaled.stats.cache_hits.values()) == 1
        if not is_loaded:
            return result, "compiled"
        return result, "cache" if before else "archive"

    def stored(self) -> list[Path]:
        return list(self.cache.rglob("*.kernel"))

    def ship(self) -> None:
        """Compile, move the machine code from the cache into the archive."""
        assert self.run() == (RESULT, "compiled")
        files = self.stored()
        code = {each.name: kernels.read_kernel(each) or b"" for each in files}
        write_archive(archive_path(self.compiled), code)
        for each in files:
            each.unlink()


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Package]:
    package = Package(tmp_path)
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(package.cache))
    monkeypatch.setattr("sys.dont_write_bytecode", True)
    monkeypatch.syspath_prepend(tmp_path)
    path = archive_path(package.compiled)
    monkeypatch.setattr(kernel_archive, "archive_path", lambda: path)
    package.ship()
    yield package
    kernels._folder.cache_clear()
    kernel_archive.select_processor.cache_clear()
    kernel_archive.package_archive.cache_clear()


@pytest.mark.parametrize("chosen", [None, "generic"])
def test_every_host_compiles_for_the_generic_processor(chosen: str | None) -> None:
    code = (
        "import navette.files.kernels\n"
        "from numba.core.registry import cpu_target\n"
        "print(cpu_target.target_context.codegen().magic_tuple()[1])\n"
    )
    environment = {k: v for k, v in os.environ.items() if not k.startswith("NUMBA_")}
    if chosen is not None:
        environment["NUMBA_CPU_NAME"] = chosen
    command = [sys.executable, "-c", code]
    output = subprocess.check_output(command, env=environment, text=True)
    generic = kernel_archive.generic_processor()
    assert generic is not None
    assert output.strip() == (chosen or generic.name)


def test_kernels_of_the_package_are_not_compiled(package: Package) -> None:
    assert package.run() == (RESULT, "archive")
    assert not package.stored()


@pytest.mark.parametrize(
    ("old", "new", "result"),
    [("FACTOR * x", "FACTOR + x", 5.0), ("FACTOR = 2.0", "FACTOR = 3.0", 9.0)],
)
def test_changed_kernels_are_compiled(
    package: Package, old: str, new: str, result: float
) -> None:
    package.module.write_text(KERNEL.replace(old, new))
    assert package.run() == (result, "compiled")
    assert package.run() == (result, "cache")


def test_another_numba_compiles(
    package: Package, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("numba.__version__", "0.0.1")
    assert package.run() == (RESULT, "compiled")


def test_an_older_processor_compiles(
    package: Package, monkeypatch: pytest.MonkeyPatch
) -> None:
    newer = GenericProcessor("x86-64-v9", frozenset({"of the future"}))
    machines = dict.fromkeys(kernel_archive._GENERIC, newer)
    monkeypatch.setattr(kernel_archive, "_GENERIC", machines)
    assert package.run() == (RESULT, "compiled")


def test_a_processor_that_the_user_chose_compiles(
    package: Package, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("numba.config.CPU_NAME", "generic")
    assert package.run() == (RESULT, "compiled")


def _flip(content: bytes) -> bytes:
    middle = len(content) // 2
    return content[:middle] + bytes([content[middle] ^ 1]) + content[middle + 1 :]


@pytest.mark.parametrize(
    "damage",
    [
        lambda content: b"",
        lambda content: content[: len(content) // 2],
        lambda content: b"x",
        _flip,
    ],
    ids=["empty", "truncated", "replaced", "one bit"],
)
def test_a_damaged_archive_is_not_used(
    package: Package, damage: Callable[[bytes], bytes]
) -> None:
    path = kernel_archive.archive_path()
    path.write_bytes(damage(path.read_bytes()))
    assert package.run() == (RESULT, "compiled")
    assert package.run() == (RESULT, "cache")


@pytest.mark.parametrize(
    "code", [b"", b"\x80", pickle.dumps(1), b"cmodule_that_is_gone\nSize\n."]
)
def test_a_file_of_another_content_is_compiled_once(
    package: Package, code: bytes
) -> None:
    path = kernel_archive.archive_path()
    (name,) = zipfile.ZipFile(path).namelist()
    write_archive(path, {name: code})
    assert package.run() == (RESULT, "compiled")
    assert package.run() == (RESULT, "cache")


def test_the_same_kernels_give_the_same_archive(tmp_path: Path) -> None:
    paths = [tmp_path / "one.zip", tmp_path / "other.zip"]
    code = {"b.kernel": b"2", "a.kernel": b"1"}
    write_archive(paths[0], code)
    write_archive(paths[1], dict(reversed(code.items())))
    assert paths[0].read_bytes() == paths[1].read_bytes()


def test_a_complete_archive_needs_no_preparation(
    package: Package, monkeypatch: pytest.MonkeyPatch
) -> None:
    kernel_archive.package_archive.cache_clear()
    assert kernels.are_prepared("1.0")
    monkeypatch.setattr("numba.__version__", "0.0.1")
    assert not kernels.are_prepared("1.0")


def test_edited_sources_need_preparation(
    tmp_path: Path, package: Package, monkeypatch: pytest.MonkeyPatch
) -> None:
    source = tmp_path / "navette" / "grids.py"
    source.parent.mkdir()
    source.write_text("@kernel\n")
    monkeypatch.setattr(kernel_archive, "_PACKAGE", source.parent)
    write_archive(kernel_archive.archive_path(), {"a.kernel": b"1"})
    kernel_archive.package_archive.cache_clear()
    assert kernels.are_prepared("1.0")
    source.write_text("@kernel # edited\n")
    assert not kernels.are_prepared("1.0")
    source.unlink()
    assert not kernels.are_prepared("1.0")
