# SPDX-License-Identifier: Apache-2.0
# mypy: allow-untyped-calls
"""Load the stored machine code of a kernel, and no more than it needs to run.

Numba's own loading takes twice the time, for what only a later compilation reads
(decision 0044): the bitcode of the kernel, which its callers inline, and the modules
with the functions of Numba that it called.
"""

import io
import pickle
from typing import Any

import llvmlite.binding as llvm
from numba.core import compiler
from numba.core.codegen import JITCodeLibrary
from numba.core.environment import Environment, lookup_environment


class StoredLibrary(JITCodeLibrary):
    """Machine code of a kernel, whose bitcode is parsed when it is asked for."""

    def __init__(self, codegen: Any, name: str, code: bytes, bitcode: bytes) -> None:
        super().__init__(codegen, name)
        self._bitcode = bitcode
        self.enable_object_caching()
        self._set_compiled_object(code)
        self._finalize_final_module()

    def _get_module_for_linking(self) -> Any:
        self._parse_bitcode()
        return self._shared_module

    def get_pointer_to_function(self, name: str) -> int:
        if not self.codegen._engine.is_symbol_defined(name):
            self._parse_bitcode()
        pointer: int = super().get_pointer_to_function(name)
        return pointer

    def _parse_bitcode(self) -> None:
        if self._shared_module is None:
            self._shared_module = llvm.parse_bitcode(self._bitcode)
            self.codegen._engine._load_defined_symbols(self._shared_module)


class _Unpickler(pickle.Unpickler):
    """Reads environments without importing the modules whose globals they would hold.

    Machine code reads their constants only.
    """

    def find_class(self, module: str, name: str) -> Any:
        if (module, name) == ("numba.core.environment", "_rebuild_env"):
            return _make_environment
        return super().find_class(module, name)


def _make_environment(module: str, constants: list[Any], name: str) -> Any:
    known = lookup_environment(name)
    if known is not None:
        return known
    environment = Environment({"__name__": module})
    environment.consts[:] = constants
    environment.env_name = name
    Environment._memo[name] = environment
    return environment


def load_kernel(target_context: Any, data: bytes) -> Any:
    """Return the compiled function that Numba's ``CompileResult._reduce`` described.

    Raises:
        Exception: whatever a damaged or outdated pickle raises.
    """
    (
        (name, _, (code, bitcode)),
        descriptor,
        environment,
        signature,
        object_mode,
        lifted,
        annotation,
        initializers,
        environments,
    ) = _Unpickler(io.BytesIO(data)).load()
    for initialize in initializers:
        initialize()
    codegen = target_context.codegen()
    library = StoredLibrary(codegen, name, code, bitcode)
    codegen._engine._defined_symbols.add(descriptor.llvm_cpython_wrapper_name)
    entry_point = target_context.get_executable(library, descriptor, environment)
    for each in environments:
        codegen.set_env(each.env_name, each)
    result: Any = compiler.CompileResult
    return result(
        target_context=target_context,
        typing_context=target_context.typing_context,
        library=library,
        environment=environment,
        entry_point=entry_point,
        fndesc=descriptor,
        type_annotation=annotation,
        signature=signature,
        objectmode=object_mode,
        lifted=lifted,
        typing_error=None,
        call_helper=None,
        metadata=None,
        reload_init=initializers,
        referenced_envs=environments,
    )
