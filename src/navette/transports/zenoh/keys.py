"""Names on the wire: key expressions of topics and services, DDS names of types.

As in rmw_zenoh (Jazzy from 0.2.4, Kilted, Rolling).
"""

import re

from navette.errors import DecodeError, InvalidValueError
from navette.msgs import type_hash
from navette.msgs.registry import distro

_TYPE = re.compile(r"([A-Za-z]\w*)/(msg|srv|action)/([A-Za-z]\w*)", re.ASCII)
_DDS_TYPE = re.compile(r"([A-Za-z]\w*)::(msg|srv|action)::dds_::([A-Za-z]\w*)_", re.A)
_MANGLED_NAME = re.compile(r"(%[A-Za-z_]\w*)+", re.ASCII)


def dds_type_name(type_name: str) -> str:
    """Return ``geometry_msgs::msg::dds_::Twist_`` for ``geometry_msgs/msg/Twist``."""
    match = _TYPE.fullmatch(type_name)
    if match is None:
        raise InvalidValueError(
            f"type {type_name!r}: expected package/msg/Name, /srv/ or /action/"
        )
    return "{}::{}::dds_::{}_".format(*match.groups())


def ros_type_name(dds_name: str) -> str:
    """Return the ROS 2 type name for a DDS type name.

    Raises:
        DecodeError: ``dds_name`` is not the DDS name of a ROS 2 type.
    """
    match = _DDS_TYPE.fullmatch(dds_name)
    if match is None:
        raise DecodeError(f"{dds_name!r} is not the DDS name of a ROS 2 type")
    return "/".join(match.groups())


def wire_hash(type_name: str) -> str:
    """Return the hash of a type in keys and tokens; Humble's have a word instead."""
    return "TypeHashNotSupported" if distro() == "humble" else type_hash(type_name)


def data_key(domain_id: int, name: str, type_name: str, type_hash: str) -> str:
    """Return the key expression of a topic's samples or a service's requests."""
    return f"{domain_id}/{name.lstrip('/')}/{dds_type_name(type_name)}/{type_hash}"


def mangled(name: str) -> str:
    """Return a full name as one chunk of a key expression; the root is ``%``."""
    return name.replace("/", "%")


def demangled_name(chunk: str) -> str:
    """Return the full name of a topic, service or namespace other than the root.

    Raises:
        DecodeError: ``chunk`` is not a mangled name.
    """
    if not _MANGLED_NAME.fullmatch(chunk):
        raise DecodeError(f"{chunk!r} is not a mangled name")
    return chunk.replace("%", "/")
