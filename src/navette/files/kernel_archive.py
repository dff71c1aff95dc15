# SPDX-License-Identifier: Apache-2.0
"""Machine code in the package: kernels compiled for a generic processor.

A wheel contains an archive for the Python and the platform on which it was built
(``navette.navigation.stack.kernel_build``). Each file in it has the name that the
kernel cache gives it, a digest of everything that the machine code depends on. A kernel
that was edited, another version of Numba or Python, or other argument types are thus
not found in the archive, and the kernel is compiled.
"""

import functools
import hashlib
import io
import json
import logging
import platform
import sys
import zipfile
import zlib
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import llvmlite.binding as llvm
import numba

_PACKAGE = Path(__file__).parents[1]
_FOLDER = _PACKAGE / "files" / "compiled"
_log = logging.getLogger(__name__)


class GenericProcessor(NamedTuple):
    """What the machine code of kernels requires of a processor.

    Attributes:
        name: LLVM's name of the processor.
        features: those of LLVM that the host must have.
    """

    name: str
    features: frozenset[str]


_X86_64_V3 = GenericProcessor(
    "x86-64-v3",
    frozenset(
        "avx avx2 bmi bmi2 cmov cx8 cx16 f16c fma fxsr lzcnt mmx movbe popcnt sahf "
        "sse sse2 sse3 sse4.1 sse4.2 ssse3 xsave".split()
    ),
)
_ARM64 = GenericProcessor("generic", frozenset())
_GENERIC = {
    "x86_64": _X86_64_V3,
    "amd64": _X86_64_V3,
    "aarch64": _ARM64,
    "arm64": _ARM64,
}


def generic_processor() -> GenericProcessor | None:
    """Return the generic processor whose machine code this host can run, or None."""
    generic = _GENERIC.get(platform.machine().lower())
    if generic is None:
        return None
    if generic.features:
        available = llvm.get_host_cpu_features()
        if not all(available.get(each, False) for each in generic.features):
            return None
    return generic


@functools.cache
def select_processor() -> GenericProcessor | None:
    """Compile for the generic processor, so that every host gets the same results.

    The width of its vectors decides in which order ``fastmath`` kernels add. With
    ``NUMBA_CPU_NAME`` or ``NUMBA_CPU_FEATURES`` the user selects another processor.

    Returns:
        The generic processor; None if another one is compiled for.
    """
    config: Any = numba.config
    generic = generic_processor()
    if generic is None:
        return None
    selected = (generic.name, "")  # those features that the name implies
    if (config.CPU_NAME, config.CPU_FEATURES) not in ((None, None), selected):
        return None
    config.CPU_NAME, config.CPU_FEATURES = selected
    return generic


def archive_path(folder: Path = _FOLDER) -> Path:
    """Return the path of the archive for this Python and platform."""
    system = f"{sys.platform}-{platform.machine().lower()}"
    return folder / f"{sys.implementation.cache_tag}-{system}.zip"


class KernelArchive:
    """The kernels of an archive, in memory: forked processes share no file position."""

    def __init__(self, content: bytes) -> None:
        """Open an archive.

        Raises:
            zipfile.BadZipFile: it is damaged.
        """
        self._files = zipfile.ZipFile(io.BytesIO(content))
        self._names = frozenset(self._files.namelist())

    def read(self, name: str) -> bytes | None:
        """Return the machine code of a kernel; None if it is absent or damaged."""
        if name not in self._names:
            return None
        try:
            return self._files.read(name)
        except (zipfile.BadZipFile, zlib.error) as error:
            _log.debug("%s in the package: %r; compiling", name, error)
            return None

    def is_complete(self) -> bool:
        """Return whether it was built from this package's kernels with this Numba."""
        try:
            origin: Any = json.loads(self._files.comment)
            return bool(origin == _origin(origin["modules"]))
        except (ValueError, LookupError, TypeError, OSError):
            return False


@functools.cache
def package_archive() -> KernelArchive | None:
    """Return the package's archive, if there is one that this process may use.

    It holds machine code for the generic processor only.
    """
    config: Any = numba.config
    if select_processor() is None or config.DISABLE_JIT:
        return None
    try:
        return KernelArchive(archive_path().read_bytes())
    except OSError:
        return None
    except zipfile.BadZipFile as error:
        _log.debug("%s: %r; compiling", archive_path(), error)
        return None


def write_archive(path: Path, kernels: Mapping[str, bytes]) -> None:
    """Write machine code by name of file; the same code gives the same bytes."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with zipfile.ZipFile(path, "w") as archive:
        archive.comment = json.dumps(_origin(_modules_with_kernels())).encode()
        for name, code in sorted(kernels.items()):
            member = zipfile.ZipInfo(name)  # without the time of the build
            archive.writestr(member, code, zipfile.ZIP_DEFLATED, 9)


def _modules_with_kernels() -> list[str]:
    return [
        path.relative_to(_PACKAGE).as_posix()
        for path in sorted(_PACKAGE.rglob("*.py"))
        if b"@kernel" in path.read_bytes()
    ]


def _origin(modules: Iterable[str]) -> dict[str, Any]:
    """Return the versions and a digest of the modules with kernels.

    Raises:
        OSError: one of them cannot be read.
    """
    digest = hashlib.sha256()
    for each in modules:
        digest.update((_PACKAGE / each).read_bytes())
    return {
        "numba": numba.__version__,
        "modules": list(modules),
        "sources": digest.hexdigest(),
    }
