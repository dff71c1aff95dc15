"""Convert recorded definitions to ``ros2msg`` text."""

from navette.bags.bag import RecordedChannel
from navette.errors import FileFormatError
from navette.msgs.definition_sections import MAX_CHARACTERS

_IDL_SEPARATOR = "=" * 80 + "\nIDL: "


def ros2_name(name: str) -> str:
    """``pkg/Name`` → ``pkg/msg/Name``; other names stay."""
    package, slash, rest = name.partition("/")
    return f"{package}/msg/{rest}" if slash and "/" not in rest else name


def msg_text(channel: RecordedChannel) -> str:
    """Return a channel's definition as ``ros2msg`` text; "" if it has none.

    Raises:
        FileFormatError: an invalid IDL definition.
    """
    text = (channel.schema or b"").decode("utf-8", "replace")
    if channel.schema_encoding == "ros2idl":
        return idl_to_msg(ros2_name(channel.schema_name), text)
    return text if channel.schema_encoding == "ros2msg" else ""


def idl_to_msg(name: str, text: str) -> str:
    """Convert an IDL definition to ``ros2msg`` text.

    Raises:
        FileFormatError: invalid IDL, or too large.
    """
    from rosbags.typesys import Stores, TypesysError, get_types_from_idl, get_typestore

    if len(text) > MAX_CHARACTERS:
        raise FileFormatError(name, f"definition of {len(text)} characters")
    store = get_typestore(Stores.EMPTY)
    try:
        for section in text.split(_IDL_SEPARATOR):
            body = section.partition("\n")[2] if _IDL_SEPARATOR in text else section
            if body.strip():
                store.register(get_types_from_idl(body))
        return store.generate_msgdef(name, ros_version=2)[0]
    except (TypesysError, KeyError, ValueError, RecursionError) as error:
        raise FileFormatError(name, f"IDL definition: {error}") from error
