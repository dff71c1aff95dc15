"""Types of the fields of messages (``SLOT_TYPES``)."""

from navette.msgs.slot_types import (
    AbstractGenericString,
    AbstractNestableType,
    AbstractNestedType,
    AbstractSequence,
    AbstractString,
    AbstractType,
    AbstractWString,
    Array,
    BasicType,
    BoundedSequence,
    BoundedString,
    BoundedWString,
    NamedType,
    NamespacedType,
    UnboundedSequence,
    UnboundedString,
    UnboundedWString,
)

FLOATING_POINT_TYPES = ("float", "double", "long double")
SIGNED_NONEXPLICIT_INTEGER_TYPES = ("short", "long", "long long")
UNSIGNED_NONEXPLICIT_INTEGER_TYPES = (
    "unsigned short",
    "unsigned long",
    "unsigned long long",
)
SIGNED_EXPLICIT_INTEGER_TYPES = ("int8", "int16", "int32", "int64")
UNSIGNED_EXPLICIT_INTEGER_TYPES = ("uint8", "uint16", "uint32", "uint64")
SIGNED_INTEGER_TYPES = SIGNED_NONEXPLICIT_INTEGER_TYPES + SIGNED_EXPLICIT_INTEGER_TYPES
UNSIGNED_INTEGER_TYPES = (
    UNSIGNED_NONEXPLICIT_INTEGER_TYPES + UNSIGNED_EXPLICIT_INTEGER_TYPES
)
INTEGER_TYPES = SIGNED_INTEGER_TYPES + UNSIGNED_INTEGER_TYPES
CHARACTER_TYPES = ("char", "wchar")
BOOLEAN_TYPE = "boolean"
OCTET_TYPE = "octet"
BASIC_TYPES = (
    *INTEGER_TYPES,
    *FLOATING_POINT_TYPES,
    *CHARACTER_TYPES,
    BOOLEAN_TYPE,
    OCTET_TYPE,
)

__all__ = [
    "BASIC_TYPES",
    "BOOLEAN_TYPE",
    "CHARACTER_TYPES",
    "FLOATING_POINT_TYPES",
    "INTEGER_TYPES",
    "OCTET_TYPE",
    "SIGNED_EXPLICIT_INTEGER_TYPES",
    "SIGNED_INTEGER_TYPES",
    "SIGNED_NONEXPLICIT_INTEGER_TYPES",
    "UNSIGNED_EXPLICIT_INTEGER_TYPES",
    "UNSIGNED_INTEGER_TYPES",
    "UNSIGNED_NONEXPLICIT_INTEGER_TYPES",
    "AbstractGenericString",
    "AbstractNestableType",
    "AbstractNestedType",
    "AbstractSequence",
    "AbstractString",
    "AbstractType",
    "AbstractWString",
    "Array",
    "BasicType",
    "BoundedSequence",
    "BoundedString",
    "BoundedWString",
    "NamedType",
    "NamespacedType",
    "UnboundedSequence",
    "UnboundedString",
    "UnboundedWString",
]
