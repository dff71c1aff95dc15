"""rosidl_runtime_py.import_message: class of a field's type."""

from typing import Any
from warnings import warn

from navette.msgs import get_interface
from navette.msgs.slot_types import AbstractNestedType

_FEEDBACK = "_FeedbackMessage"


def import_message_from_namespaced_type(message_type: Any) -> Any:
    """Return the class of a NamespacedType or of a name.

    Raises:
        UnknownNameError: unknown interface.
    """
    if isinstance(message_type, AbstractNestedType):
        warn(
            "import_message_from_namespaced_type() of a sequence; pass its value_type",
            DeprecationWarning,
            stacklevel=2,
        )
        message_type = message_type.value_type
    if isinstance(message_type, str):
        name = message_type
    else:
        name = "/".join((*message_type.namespaces, message_type.name))
    if name.endswith(_FEEDBACK):
        action: Any = get_interface(name.removesuffix(_FEEDBACK))
        return action.Impl.FeedbackMessage
    return get_interface(name)
