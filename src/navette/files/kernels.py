# SPDX-License-Identifier: Apache-2.0
"""Numba kernels, and where their machine code is stored between runs.

Numba's own cache writes beside the source and raises where that is read-only or a file
is damaged; its stamp covers only the file of the kernel itself. Here each kernel and
signature has one file in the cache folder of the user. Its name covers everything that
the machine code depends on, so that other versions of Navette, Numba and Python, and
other processors, use other files.
"""

import functools
import hashlib
import logging
import os
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any, ParamSpec, TypeVar, overload

import numba
from numba import types
from numba.core import serialize, sigutils
from numba.core.caching import NullCache
from numba.core.dispatcher import Dispatcher
from numba.core.runtime.nrt import rtsys

from navette.files.folders import cache_folder, is_private
from navette.files.held_signals import held_signals
from navette.files.kernel_archive import package_archive, select_processor
from navette.files.machine_code import load_kernel

VARIABLE = "NUMBA_CACHE_DIR"
_SUFFIX = ".kernel"
_DIGEST = hashlib.sha256
_DIGEST_BYTES = 32
_HASH_SYMBOLS = b"_numba_hashsecret"  # of sets and dicts; defined by a refresh
_UNUSED_S = 30 * 86_400  # after which a file is deleted
_log = logging.getLogger(__name__)

select_processor()  # before Numba compiles or loads

P = ParamSpec("P")
T = TypeVar("T")


@overload
def kernel(function: Callable[P, T]) -> Callable[P, T]: ...
@overload
def kernel(
    *, signature: str | None = None, allocates: bool = True, **options: Any
) -> Callable[[Callable[P, T]], Callable[P, T]]: ...


def kernel(
    function: Any = None,
    *,
    signature: str | None = None,
    allocates: bool = True,
    **options: Any,
) -> Any:
    """Compile a function with Numba on its first call, or load it from the cache.

    Args:
        function: arrays and numbers in and out; its globals are numbers, modules and
            other kernels.
        signature: the only types that it takes; compiled or loaded at once.
        allocates: False for a kernel that creates and returns no arrays, so that no
            references are counted. In small kernels that others call, counting took
            four times as long as the work of a lattice search.
        options: of ``numba.njit``.

    Kernels release the GIL: other threads run meanwhile.
    """
    if function is None:
        return functools.partial(
            kernel, signature=signature, allocates=allocates, **options
        )
    options = {"nogil": True, **options}
    if not allocates:
        options["_nrt"] = False
    compiled: Any = numba.njit(**options)(function)
    if compiled is not function:  # it is with NUMBA_DISABLE_JIT
        compiled._cache = KernelCache(function, options)
        compiled.compile = functools.partial(_compile, compiled.compile)
        if signature is not None:
            compiled.compile(signature)
            compiled.disable_compile()
    return compiled


def _compile(compile_or_load: Callable[[Any], Any], signature: Any) -> Any:
    with held_signals():  # LLVM calls back with its machine code
        return compile_or_load(signature)


KernelFunction = Callable[..., Any]
"""The Python function of a kernel."""


class KernelCache(NullCache):
    """Machine code of one kernel on disk: Numba's interface of a cache.

    A file that is absent, damaged or not private to the user counts as not cached.
    """

    def __init__(self, function: KernelFunction, options: Mapping[str, Any]) -> None:
        self._function: Any = function
        self._options = repr(sorted(options.items()))

    @property
    def cache_path(self) -> str | None:
        folder = _folder()
        return None if folder is None else str(folder)

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        # Numba's own cache refreshes the context here, which imports what it compiles
        # with. Machine code requires only the symbols of the runtime.
        initialize: Any = rtsys.initialize
        initialize(target_context)
        name = self._file_name(sig, _processor(target_context.codegen()))
        for read in (_read_packaged, _read_stored):
            data = read(name)
            if data is None:
                continue
            if _HASH_SYMBOLS in data:
                target_context.refresh()
            try:
                return load_kernel(target_context, data)
            except Exception as error:  # unpickling raises whatever a class raises
                _log.debug("%s: %r; compiling", self._function.__name__, error)
        return None

    def save_overload(self, sig: Any, data: Any) -> None:
        folder = _folder()
        if folder is None or data.library.has_dynamic_globals:
            return
        path = folder / self._file_name(sig, _processor(data.codegen))
        try:
            dumps: Any = serialize.dumps
            _write(path, dumps(data._reduce()))
            _delete_unused(folder, path.stat().st_mtime)
        except OSError as error:
            _log_once(f"cannot store compiled kernels in {folder}: {error.strerror}")

    def _file_name(self, sig: Any, processor: tuple[str, ...]) -> str:
        normalize: Any = sigutils.normalize_signature
        arguments, _ = normalize(sig)
        parts = [
            numba.__version__,
            str(sys.implementation.cache_tag),
            self._options,
            *map(str, processor),
            *(part for each in arguments for part in _describe_type(each)),
            *_describe_function(self._function),
        ]
        digest = _DIGEST(b"".join(_DIGEST(p.encode()).digest() for p in parts))
        return f"{self._function.__name__}-{digest.hexdigest()[:32]}{_SUFFIX}"


@functools.cache
def _folder() -> Path | None:
    return cache_folder("kernels", preferred=os.environ.get(VARIABLE))


@functools.cache
def _processor(codegen: Any) -> tuple[str, ...]:
    """Return triple, name and features: those of the start, which Numba may reset."""
    return tuple(codegen.magic_tuple())


def _read_packaged(name: str) -> bytes | None:
    archive = package_archive()
    return None if archive is None else archive.read(name)


def _read_stored(name: str) -> bytes | None:
    folder = _folder()
    return None if folder is None else read_kernel(folder / name)


@functools.cache
def _log_once(message: str) -> None:
    _log.warning(message)


def read_kernel(path: Path) -> bytes | None:
    """Return the machine code if it is complete and no other user wrote it."""
    try:
        with path.open("rb") as file:
            status = os.fstat(file.fileno())
            if not is_private(status):
                return None
            content = file.read()
        os.utime(path)  # marks the file as in use
    except OSError:
        return None
    data = content[_DIGEST_BYTES:]
    return data if content[:_DIGEST_BYTES] == _seal(path, data) else None


def _write(path: Path, data: bytes) -> None:
    """Write the file at once, so that other processes see all of it or nothing."""
    descriptor, temporary = tempfile.mkstemp(dir=path.parent, suffix=".tmp")
    try:
        with os.fdopen(descriptor, "wb") as file:
            file.write(_seal(path, data) + data)
        Path(temporary).replace(path)
    except OSError:
        Path(temporary).unlink(missing_ok=True)
        raise


def _seal(path: Path, data: bytes) -> bytes:
    return _DIGEST(path.name.encode() + data).digest()


def _delete_unused(folder: Path, now: float) -> None:
    """Delete files of versions that are no longer used."""
    for path in folder.iterdir():
        try:
            if now - path.stat().st_mtime > _UNUSED_S:
                path.unlink()
        except FileNotFoundError:  # another process was first
            continue


def _describe_type(numba_type: Any) -> Iterator[str]:
    """Yield what identifies a type; the names of named tuples omit their fields."""
    yield str(numba_type)
    if not isinstance(numba_type, types.BaseTuple):
        return
    members: Any = numba_type
    if isinstance(numba_type, types.BaseNamedTuple):
        record = members.instance_class
        yield f"{record.__module__}.{record.__qualname__}{record._fields}"
    for each in members:
        yield from _describe_type(each)


@functools.cache
def _describe_function(function: Any) -> tuple[str, ...]:
    """Return code and globals of a function and of the kernels that it calls."""
    parts: list[str] = []
    done = set()
    waiting = [function]
    while waiting:
        current = waiting.pop()
        done.add(current)
        parts += _describe_code(current.__code__)
        for name in current.__code__.co_names:
            value = current.__globals__.get(name)
            if isinstance(value, Dispatcher):
                parts.append(f"{name} {sorted(value.targetoptions.items())}")
                if value.py_func not in done:
                    waiting.append(value.py_func)
            elif isinstance(value, ModuleType):
                parts.append(value.__name__)
            elif isinstance(value, bool | int | float):
                parts.append(f"{name} {value!r}")
            elif value is not None:
                raise TypeError(
                    f"kernel {function.__name__}: {name} is a {type(value).__name__}; "
                    "globals of a kernel must be numbers, modules or kernels"
                )
    return tuple(parts)


def _describe_code(code: CodeType) -> Iterator[str]:
    yield code.co_code.hex()
    yield repr(code.co_names)
    yield repr(code.co_varnames)
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _describe_code(constant)
        else:
            yield repr(constant)


def stored_kernels() -> int:
    """Return the number of kernels whose machine code is stored."""
    folder = _folder()
    return 0 if folder is None else sum(1 for _ in folder.glob(f"*{_SUFFIX}"))


def are_prepared(name: str) -> bool:
    """Return whether :func:`note_prepared` was called for kernels of this name.

    The name contains the version of Navette.

    True also where nothing can be stored, and where the package contains them.
    """
    archive = package_archive()
    if archive is not None and archive.is_complete():
        return True
    mark = _mark(name)
    if mark is None:
        return True
    try:
        os.utime(mark)  # marks the file as in use
    except OSError:
        return False
    return True


def note_prepared(name: str) -> None:
    """Note that the kernels of this name have been compiled and stored."""
    mark = _mark(name)
    if mark is not None:
        try:
            mark.touch()
        except OSError as error:
            _log_once(f"cannot note the compiled kernels: {error.strerror}")


def _mark(name: str) -> Path | None:
    """Return the file that exists if the kernels of a name are stored."""
    folder = _folder()
    config: Any = numba.config
    if folder is None or config.DISABLE_JIT:
        return None
    python = sys.implementation.cache_tag
    return folder / f"navette-{name}-numba-{numba.__version__}-{python}.prepared"
