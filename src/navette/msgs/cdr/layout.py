"""Layout of values in a CDR stream.

Plain CDR (OMG CORBA 3.4 part 2, section 9.3; DDS-XTypes 1.3, "XCDR1"): every primitive
is aligned to its size, counted from the end of the 4-byte header. Consecutive
primitives form a *run*, packed by one ``struct`` call. If the offset of a run is known
only at run time, its padding depends on that offset modulo 8 (the *phase*): a table
contains the eight cases.
"""

from dataclasses import dataclass, field
from struct import Struct

from navette.msgs.interface import FieldType, MessageSpec
from navette.msgs.registry import get_message_spec
from navette.msgs.values import DTYPES, TYPECODES

# struct code and size; a bool is read as an integer, to detect values other than 0, 1.
CODES = {"bool": ("B", 1), "byte": ("c", 1)}
CODES |= {base: (code, DTYPES[base].itemsize) for base, code in TYPECODES.items()}
PHASES = 8


@dataclass
class Run:
    """Consecutive primitives; items are (alignment, struct code, bytes, expression)."""

    items: list[tuple[int, str, int, str]] = field(default_factory=list)

    def add(self, alignment: int, code: str, size: int, expression: str) -> None:
        self.items.append((alignment, code, size, expression))

    @property
    def expressions(self) -> list[str]:
        """Expressions to pack, or variables to unpack into."""
        return [item[3] for item in self.items]

    @property
    def alignment(self) -> int:
        """The greatest alignment in the run."""
        return max((item[0] for item in self.items), default=1)

    def layout(self, phase: int) -> tuple[str, int]:
        """struct format (without byte order) and length in bytes at ``phase``."""
        offset = phase
        codes = []
        for alignment, code, size, _ in self.items:
            padding = -offset % alignment
            codes.append(f"{padding}x" if padding > 1 else "x" * padding)
            codes.append(code)
            offset += padding + size
        return "".join(codes), offset - phase

    def table(self, order: str, prefix: str = "") -> list[tuple[Struct, int]]:
        """Struct and length in bytes for each phase 0…7."""
        layouts = [self.layout(phase) for phase in range(PHASES)]
        return [(Struct(order + prefix + codes), length) for codes, length in layouts]

    def end_phase(self, phase: int | None) -> int | None:
        """Phase after the run; None if it depends on an unknown phase before."""
        if phase is None:
            ends = {(p + self.layout(p)[1]) % PHASES for p in range(PHASES)}
            return ends.pop() if len(ends) == 1 else None
        return (phase + self.layout(phase)[1]) % PHASES


@dataclass(frozen=True)
class Leaf:
    """A primitive inside a message: its type and the path of field names to it."""

    path: tuple[str, ...]
    base: str


def uniform_leaves(spec: MessageSpec) -> list[Leaf] | None:
    """Primitives of a message whose elements in a list all have the same layout.

    None if it contains strings, arrays or bools (which are checked one by one), or if
    padding differs between elements: CDR aligns primitives, not structures, so the
    first must have the greatest alignment and the length must be a multiple of it.
    """
    leaves: list[Leaf] = []
    for each in spec.fields:
        if not each.type.is_scalar or each.type.is_string or each.type.base == "bool":
            return None
        if not each.type.is_message:
            leaves.append(Leaf((each.name,), each.type.base))
            continue
        inner = uniform_leaves(get_message_spec(each.type.base))
        if inner is None:
            return None
        leaves += [Leaf((each.name, *leaf.path), leaf.base) for leaf in inner]
    run = leaf_run(leaves)
    is_uniform = (
        bool(leaves)
        and run.items[0][0] == run.alignment
        and run.layout(0)[1] % run.alignment == 0
    )
    return leaves if is_uniform else None


def leaf_run(leaves: list[Leaf]) -> Run:
    run = Run()
    for leaf in leaves:
        code, size = CODES[leaf.base]
        run.add(size, code, size, "")
    return run


def item_size(type_: FieldType) -> int:
    """Smallest size of one element of the type in bytes, without padding."""
    if type_.is_message:
        return least_size(get_message_spec(type_.base))
    if type_.is_string:
        return 4
    return CODES[type_.base][1]


def least_size(spec: MessageSpec) -> int:
    """Smallest size of a message in bytes, to check lengths in untrusted data."""
    total = 0
    for each in spec.wire_fields:
        if each.type.container == "sequence":
            total += 4
        else:
            total += item_size(each.type) * (each.type.size or 1)
    return total
