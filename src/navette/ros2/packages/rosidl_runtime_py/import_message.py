"""rosidl_runtime_py.import_message: the class that a field's type names."""

from typing import Any

from navette.msgs import get_interface
from navette.msgs.interface import FieldType

_FEEDBACK = "_FeedbackMessage"


def import_message_from_namespaced_type(message_type: Any) -> Any:
    """The class of a type in ``SLOT_TYPES``, of a name, or of a NamespacedType.

    Raises:
        UnknownNameError: nobody defines it.
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
