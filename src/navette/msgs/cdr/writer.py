"""Generated serialisation: message → CDR, little-endian."""

from collections.abc import Callable
from typing import Any

from navette.msgs.base import Message
from navette.msgs.cdr.elements import PACK, WIDE_UNIT, encode_wide
from navette.msgs.cdr.layout import CODES, PHASES, Leaf, Run, leaf_run, uniform_leaves
from navette.msgs.interface import PLACEHOLDER, Field, FieldType, MessageSpec
from navette.msgs.registry import get_message_spec
from navette.msgs.values import DTYPES

HEADER = b"\x00\x01\x00\x00"

_element_writers: dict[str, Callable[..., int]] = {}


def make_writer(spec: MessageSpec) -> Callable[[Message], bytes]:
    """Return a function from a message to its bytes with the 4-byte header."""
    emitter = _Emitter(phase=0)
    emitter.message(spec, "m")
    emitter.finish_run()
    # A message that is one run takes a single pack.
    if emitter.is_single_run:
        (expression,) = emitter.parts
        hoisted = [line for line in emitter.lines if not line.startswith(" p +=")]
        lines = ["def write(m):", *hoisted, f" return {expression}"]
    else:
        emitter.flush_parts()
        lines = ["def write(m):", " parts = []", " p = 0", *emitter.lines]
        lines.append(" return join(parts)")
    function: Callable[[Message], bytes] = emitter.compile(lines, spec, "write")
    return function


def _element_writer(spec: MessageSpec) -> Callable[..., int]:
    """Return a function (message, parts, offset) → offset, appending to ``parts``."""
    found = _element_writers.get(spec.name)
    if found is None:
        emitter = _Emitter(phase=None)
        emitter.message(spec, "m")
        emitter.finish_run()
        emitter.flush_parts()
        lines = ["def element(m, parts, p):", *emitter.lines, " return p"]
        found = emitter.compile(lines, spec, "element")
        _element_writers[spec.name] = found
    return found


class _Emitter:
    """Source lines of one function and the objects they refer to.

    ``p`` in the generated code is the offset after the header; ``phase`` is ``p``
    modulo 8, or None if unknown.
    """

    def __init__(self, phase: int | None) -> None:
        self.lines: list[str] = []
        self.parts: list[str] = []
        self.scope: dict[str, Any] = {
            "HEADER": HEADER,
            "PAD": b"\0" * PHASES,
            "PAD4": b"\0\0\0\0",
            "join": b"".join,
            "encode_wide": encode_wide,
        }
        self.is_single_run = True
        self._run = Run()
        self._phase = phase
        self._needs_header = phase == 0
        self._count = 0

    def compile(self, lines: list[str], spec: MessageSpec, name: str) -> Any:
        """Compile the lines and return the function ``name``."""
        source = "\n".join(lines)
        exec(compile(source, f"<serialize {spec.name}>", "exec"), self.scope)
        return self.scope[name]

    def message(self, spec: MessageSpec, source: str) -> None:
        """Emit all fields of the message in variable ``source``."""
        for field in spec.wire_fields:
            if field.name == PLACEHOLDER:
                self._run.add(1, "B", 1, "0")
            elif field.type.is_scalar:
                self._scalar(field.type, f"{source}._{field.name}")
            elif field.type.container == "array":
                self._array(field, f"{source}._{field.name}")
            else:
                self._sequence(field, f"{source}._{field.name}")

    def _scalar(self, type_: FieldType, value: str) -> None:
        if type_.is_message:
            name = self._new_name("m")
            self.lines.append(f" {name} = {value}")
            self.message(get_message_spec(type_.base), name)
        elif type_.is_string:
            self._string(type_, value)
        else:
            code, size = CODES[type_.base]
            self._run.add(size, code, size, value)

    def _string(self, type_: FieldType, value: str) -> None:
        text = self._new_name("s")
        if type_.base == "wstring":
            self.lines.append(f" {text} = encode_wide({value})")
            self._run.add(4, "I", 4, f"len({text}) // {WIDE_UNIT}")
            self._bytes_part(text)
        else:
            self.lines.append(f" {text} = {value}.encode()")
            self._run.add(4, "I", 4, f"len({text}) + 1")
            self._bytes_part(text)
            self._run.add(1, "x", 1, "")  # the terminating zero joins the next run

    def _bytes_part(self, name: str) -> None:
        self.finish_run()
        self.parts.append(name)
        self.lines.append(f" p += len({name})")
        self._phase = None
        self.is_single_run = False

    def _array(self, field: Field, value: str) -> None:
        type_ = field.type
        if type_.is_numeric:
            size = DTYPES[type_.base].itemsize
            total = size * (type_.size or 0)
            self._run.add(size, f"{total}s", total, f"{value}.tobytes()")
            return
        items = self._new_name("a")
        self.lines.append(f" {items} = {value}")
        self._check_count(field, items, "!=")
        if type_.base in PACK:
            packed = self._packed_octets(type_, items)
            self._run.add(1, f"{type_.size}s", type_.size or 0, packed)
        else:
            self._loop(type_, items)

    def _packed_octets(self, type_: FieldType, items: str) -> str:
        packed = self._new_name("o")
        self.scope[f"pack_{type_.base}"] = PACK[type_.base]
        self.lines.append(f" {packed} = pack_{type_.base}({items})")
        return packed

    def _sequence(self, field: Field, value: str) -> None:
        type_ = field.type
        items = self._new_name("a")
        self.lines.append(f" {items} = {value}")
        if type_.size is not None:
            self._check_count(field, items, ">")
        self._run.add(4, "I", 4, f"len({items})")
        if type_.base in PACK:
            self._bytes_part(self._packed_octets(type_, items))
        elif type_.is_numeric:
            self.finish_run()
            size = DTYPES[type_.base].itemsize
            if size == PHASES:  # padding between the length and 8-byte elements
                self.lines.append(f" if p & 4 and len({items}):")
                pad = self._new_name("z")
                self.lines.append(f"  {pad} = PAD4")
                self.lines.append("  p += 4")
                self.lines.append(f" else: {pad} = b''")
                self.parts.append(pad)
            self.parts.append(items)
            self.lines.append(f" p += {size} * len({items})")
            self._phase = None
            self.is_single_run = False
        else:
            self._loop(type_, items)

    def _check_count(self, field: Field, items: str, wrong: str) -> None:
        # Fails only for a list changed in place; the caller finds the field.
        self.lines.append(f" if len({items}) {wrong} {field.type.size}:")
        self.lines.append("  raise TypeError('length')")

    def _loop(self, type_: FieldType, items: str) -> None:
        self.finish_run()
        self.flush_parts()
        self.is_single_run = False
        self._phase = None
        leaves = (
            uniform_leaves(get_message_spec(type_.base)) if type_.is_message else None
        )
        if leaves is not None:
            self._uniform_loop(items, leaves)
            return
        self.lines.append(f" for e in {items}:")
        if type_.is_message:
            writer = self._new_name("W")
            self.scope[writer] = _element_writer(get_message_spec(type_.base))
            self.lines.append(f"  p = {writer}(e, parts, p)")
            return
        self.lines.append("  q = -p & 3")
        if type_.base == "wstring":
            self.lines.append("  t = encode_wide(e)")
            self.lines.append(f"  n = len(t) // {WIDE_UNIT}")
        else:
            self.lines.append("  t = e.encode() + b'\\0'")
            self.lines.append("  n = len(t)")
        self.lines.append("  parts += (PAD[:q], n.to_bytes(4, 'little'), t)")
        self.lines.append("  p += q + 4 + len(t)")

    def _uniform_loop(self, items: str, leaves: list[Leaf]) -> None:
        """Emit one pack per element, without another Python call for each."""
        run = leaf_run(leaves)
        ((packer, length), *_) = run.table("<")
        name = self._new_name("U")
        self.scope[name] = packer.pack
        values = ", ".join(
            "e" + "".join(f"._{n}" for n in leaf.path) for leaf in leaves
        )
        if run.alignment > 1:
            self.lines += [
                f" q = -p & {run.alignment - 1}",
                f" if q and {items}:",
                "  parts.append(PAD[:q])",
                "  p += q",
            ]
        self.lines.append(f" parts += [{name}({values}) for e in {items}]")
        self.lines.append(f" p += {length} * len({items})")

    def finish_run(self) -> None:
        """Emit the packing of the collected primitives."""
        run, self._run = self._run, Run()
        if not run.items:
            if self._needs_header:
                self.parts.append("HEADER")
                self._needs_header = False
            return
        number = self._new_name("R")
        prefix = "4s" if self._needs_header else ""
        arguments = [each for each in run.expressions if each]
        if self._needs_header:
            arguments.insert(0, "HEADER")
            self._needs_header = False
        table = run.table("<", prefix)
        if self._phase is not None:
            packer, length = table[self._phase]
            self.scope[number] = packer.pack
            self.parts.append(f"{number}({', '.join(arguments)})")
            self.lines.append(f" p += {length}")
        else:
            self.scope[number] = tuple(packer.pack for packer, _ in table)
            self.scope[f"{number}n"] = tuple(length for _, length in table)
            packed = self._new_name("b")
            call = f"{number}[p & 7]({', '.join(arguments)})"
            self.lines.append(f" {packed} = {call}")
            self.lines.append(f" p += {number}n[p & 7]")
            self.parts.append(packed)
        self._phase = run.end_phase(self._phase)

    def flush_parts(self) -> None:
        """Emit the appending of the collected parts."""
        if self.parts:
            self.lines.append(f" parts += ({', '.join(self.parts)},)")
            self.parts = []

    def _new_name(self, prefix: str) -> str:
        self._count += 1
        return f"{prefix}{self._count}"
