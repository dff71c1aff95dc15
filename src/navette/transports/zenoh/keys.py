"""Names on the wire: key expressions of topics and services, DDS names of types.

As rmw_zenoh has them (Jazzy from 0.2.4, Kilted, Rolling).
"""

import re

from navette.errors import DecodeError, InvalidValueError

_TYPE = re.compile(r"([A-Za-z]\w*)/(msg|srv|action)/([A-Za-z]\w*)", re.ASCII)
_DDS_TYPE = re.compile(r"([A-Za-z]\w*)::(msg|srv|action)::dds_::([A-Za-z]\w*)_", re.A)
_NAME = re.compile(r"(/[A-Za-z_]\w*)+", re.ASCII)
_MANGLED_NAME = re.compile(r"(%[A-Za-z_]\w*)+", re.ASCII)


def dds_type_name(type_name: str) -> str:
    """``geometry_msgs::msg::dds_::Twist_`` of ``geometry_msgs/msg/Twist``."""
    match = _TYPE.fullmatch(type_name)
    if match is None:
        raise InvalidValueError(
            f"type {type_name!r}: wanted package/msg/Name, /srv/ or /action/"
        )
    return "{}::{}::dds_::{}_".format(*match.groups())


def ros_type_name(dds_name: str) -> str:
    """The inverse of :func:`dds_type_name`.

    Raises:
        DecodeError: it is no DDS name of a ROS 2 type.
    """
    match = _DDS_TYPE.fullmatch(dds_name)
    if match is None:
        raise DecodeError(f"{dds_name!r} is no DDS name of a ROS 2 type")
    return "/".join(match.groups())


def data_key(domain_id: int, name: str, type_name: str, type_hash: str) -> str:
    """Where a topic's samples, or a service's requests, travel."""
    return f"{domain_id}/{name.lstrip('/')}/{dds_type_name(type_name)}/{type_hash}"


def mangled(name: str) -> str:
    """A full name as one chunk of a key; the root is ``%``."""
    return name.replace("/", "%")


def demangled_name(chunk: str) -> str:
    """Full name of a topic, service or node's namespace (not the root).

    Raises:
        DecodeError: it is no such name.
    """
    if not _MANGLED_NAME.fullmatch(chunk):
        raise DecodeError(f"{chunk!r} is no mangled name")
    return chunk.replace("%", "/")


def is_full_name(name: str) -> bool:
    """Whether it can be a topic's or service's full name."""
    return _NAME.fullmatch(name) is not None
