"""Text of the generated modules and type stubs of ``navette.msgs.<package>``."""

import keyword

from navette.msgs.interface import (
    FLOATS,
    INTEGER_RANGES,
    ActionSpec,
    Field,
    FieldType,
    MessageSpec,
    ServiceSpec,
)
from navette.msgs.registry import get_spec

_WHAT = {"msg": "Messages", "srv": "Services", "action": "Actions"}
_GENERATED = "# Written by python -m navette.msgs.generate; do not edit.\n"
_NUMPY = {
    "char": "np.uint8",
    **{base: f"np.{base}" for base in (*INTEGER_RANGES, *FLOATS) if base != "char"},
}


def package_text(package: str) -> str:
    """Return the text of a package's ``__init__.py``."""
    return f'"""Interfaces of {package}."""\n'


def module_text(package: str, kind: str) -> str:
    """Return the text of ``msg.py``, ``srv.py`` or ``action.py``."""
    return (
        f'"""{_WHAT[kind]} of {package}, made on first use."""\n\n'
        f"{_GENERATED}"
        "from navette.msgs.lazy import module_contents\n\n"
        "__getattr__, __dir__, __all__ = module_contents(globals())\n"
    )


def stub_text(package: str, kind: str, names: list[str]) -> str:
    """Return the text of the ``.pyi``: all classes, their fields and constants."""
    writer = _StubWriter(f"navette.msgs.{package}.{kind}")
    for name in names:
        writer.add(f"{package}/{kind}/{name}")
    return writer.text()


class _StubWriter:
    def __init__(self, module: str) -> None:
        self._module = module
        self._imports: set[str] = set()
        self._blocks: list[str] = []

    def add(self, name: str) -> None:
        """Add the class of an interface and the classes of its parts."""
        spec = get_spec(name)
        if isinstance(spec, MessageSpec):
            self._message(spec)
        elif isinstance(spec, ServiceSpec):
            self._service(spec)
        else:
            self._action(spec)

    def text(self) -> str:
        """Return the stub."""
        lines = [_GENERATED]
        body = "\n\n".join(self._blocks)
        if "array[" in body:
            lines += ["from array import array", ""]
        if "ClassVar" in body:
            lines += ["from typing import ClassVar", ""]
        if "np." in body:
            lines += ["import numpy as np", ""]
        if "ArrayLike" in body:
            lines += ["from numpy.typing import ArrayLike, NDArray", ""]
        lines.append("from navette.msgs.base import Message")
        lines += [f"import {module}" for module in sorted(self._imports)]
        return "\n".join(lines) + "\n\n" + body + "\n"

    def _message(self, spec: MessageSpec) -> None:
        lines = [f"class {_class_name(spec.name)}(Message):"]
        lines += [
            f"    {constant.name}: ClassVar[{_python_type(constant.base)}]"
            for constant in spec.constants
        ]
        usable = [each for each in spec.fields if not keyword.iskeyword(each.name)]
        for field in usable:
            lines += self._attribute(field)
        self._blocks.append("\n".join([*lines, *self._constructor(usable)]))

    def _service(self, spec: ServiceSpec) -> None:
        for part in spec.parts():
            self._message(part)
        name = _class_name(spec.name)
        self._blocks.append(
            f"class {name}:\n"
            f"    Request = {name}_Request\n"
            f"    Response = {name}_Response\n"
            f"    Event = {name}_Event"
        )

    def _action(self, spec: ActionSpec) -> None:
        for part in (spec.goal, spec.result, spec.feedback, spec.feedback_message):
            self._message(part)
        self._service(spec.send_goal)
        self._service(spec.get_result)
        name = _class_name(spec.name)
        cancel = self._reference("action_msgs/srv/CancelGoal")
        status = self._reference("action_msgs/msg/GoalStatusArray")
        self._blocks.append(
            f"class {name}:\n"
            f"    Goal = {name}_Goal\n"
            f"    Result = {name}_Result\n"
            f"    Feedback = {name}_Feedback\n"
            "    class Impl:\n"
            f"        SendGoalService = {name}_SendGoal\n"
            f"        GetResultService = {name}_GetResult\n"
            f"        FeedbackMessage = {name}_FeedbackMessage\n"
            f"        CancelGoalService = {cancel}\n"
            f"        GoalStatusMessage = {status}"
        )

    def _attribute(self, field: Field) -> list[str]:
        if field.type.is_scalar or not field.type.is_numeric:
            return [f"    {field.name}: {self._read_type(field.type)}"]
        # Reading returns an array; any sequence of numbers can be assigned.
        return [
            "    @property",
            f"    def {field.name}(self) -> {self._read_type(field.type)}: ...",
            f"    @{field.name}.setter",
            f"    def {field.name}(self, value: ArrayLike) -> None: ...",
        ]

    def _constructor(self, fields: list[Field]) -> list[str]:
        if not fields:
            return ["    def __init__(self) -> None: ..."]
        lines = ["    def __init__(", "        self,", "        *,"]
        for field in fields:
            is_array = field.type.is_numeric and not field.type.is_scalar
            taken = "ArrayLike" if is_array else self._read_type(field.type)
            lines.append(f"        {field.name}: {taken} = ...,")
        return [*lines, "    ) -> None: ..."]

    def _read_type(self, type_: FieldType) -> str:
        if type_.is_message:
            item = self._reference(type_.base)
        elif type_.is_scalar or not type_.is_numeric:
            item = _python_type(type_.base)
        else:
            if type_.container == "array":
                return f"NDArray[{_NUMPY[type_.base]}]"
            return f"array[{_python_type(type_.base)}]"
        return item if type_.is_scalar else f"list[{item}]"

    def _reference(self, name: str) -> str:
        package, kind, rest = name.split("/")
        module = f"navette.msgs.{package}.{kind}"
        if module == self._module:
            return rest
        self._imports.add(module)
        return f"{module}.{rest}"


def _class_name(name: str) -> str:
    return name.rpartition("/")[2]


def _python_type(base: str) -> str:
    if base in INTEGER_RANGES:
        return "int"
    if base in FLOATS:
        return "float"
    return {"bool": "bool", "byte": "bytes"}.get(base, "str")
