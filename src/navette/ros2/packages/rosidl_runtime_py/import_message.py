"""rosidl_runtime_py.import_message: class of a field's type."""

from typing import Any

from navette.msgs import get_interface
from navette.msgs.interface import FieldType

_FEEDBACK = "_FeedbackMessage"


def import_message_from_namespaced_type(message_type: Any) -> Any:
    """Return the class of a type in ``SLOT_TYPES``, a name, or a NamespacedType.

    Raises:
        UnknownNameError: unknown interface.
    """
    if isinstance(message_type, FieldType):
        name = message_type.base
    elif isinstance(message_type, str):
        name = message_type
    else:
        name = "/".join((*message_type.namespaces, message_type.name))
    if name.endswith(_FEEDBACK):
        action: Any = get_interface(name.removesuffix(_FEEDBACK))
        return action.Impl.FeedbackMessage
    return get_interface(name)
