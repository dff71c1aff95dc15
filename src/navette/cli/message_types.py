"""Which type a topic has, and its class, from wherever somebody defines it."""

from typing import Any

from navette import msgs
from navette.cli.nearest import did_you_mean
from navette.cli.output import note
from navette.cli.peer_definitions import fetch_definition
from navette.cli.session import endpoints, fail, wait_for
from navette.errors import FileFormatError, UnknownNameError
from navette.runtime import Node
from navette.transports import Endpoint, EndpointKind


def topic_class(
    node: Node, topic: str, type_name: str | None = None, timeout_s: float | None = None
) -> Any:
    """The message class of a topic: that of the given type, or of what is published.

    Waits (and says so) where nobody has the topic yet. Ends the command where it has
    several types, another one than given, or none in time.
    """
    name = node.resolve_topic_name(topic)
    if type_name is not None:
        cls = interface_class(node, type_name, endpoints(node, name), kind="msg")
        _check_type(name, msgs.type_name(cls), endpoints(node, name))
        return cls
    if not endpoints(node, name):
        near = did_you_mean(name, (each.topic for each in endpoints(node)))
        note(f"waiting for {name}, which nobody publishes yet{near}")
        if not wait_for(node, lambda: bool(endpoints(node, name)), timeout_s):
            fail(f"nobody published {name} in {timeout_s:g} s")
    found = endpoints(node, name)
    types = sorted({each.type_name for each in found})
    if len(types) > 1:
        fail(
            f"{name} has several types ({', '.join(types)}): say which, after its name"
        )
    return interface_class(node, types[0], found, kind="msg")


def interface_class(
    node: Node, type_name: str, of: list[Endpoint], *, kind: str = ""
) -> Any:
    """The class of a type: known here, described by its users, or in the workspace.

    Args:
        of: endpoints of the topic or service; those who have the type describe it.
        kind: ``msg``, ``srv`` or ``action``; lets ``pkg/Name`` do.
    """
    name = full_type_name(type_name, kind)
    try:
        cls = msgs.get_interface(name)
    except UnknownNameError as error:
        return _class_from_outside(node, name, of, error)
    _check_hash(name, of)
    return cls


def full_type_name(type_name: str, kind: str) -> str:
    """``pkg/Name`` → ``pkg/<kind>/Name``; full names stay."""
    package, _, rest = type_name.partition("/")
    return f"{package}/{kind}/{rest}" if kind and "/" not in rest else type_name


def _class_from_outside(
    node: Node, name: str, of: list[Endpoint], unknown: UnknownNameError
) -> Any:
    users = [each for each in of if each.type_name == name]
    reasons = []
    for full_name in dict.fromkeys(
        each.node_full_name for each in _servers_first(users)
    ):
        definition = fetch_definition(node, full_name, name)
        if definition.text is None:
            reasons.append(f"{full_name}: {definition.reason}")
            continue
        try:
            return msgs.register_definition(name, definition.text)
        except (FileFormatError, ValueError) as error:
            reasons.append(f"{full_name}: {error}")
    from navette.packages import activate

    activate()
    try:
        return msgs.get_interface(name)
    except UnknownNameError:
        fail(
            "; ".join([f"type {name} is not known here: {unknown}", *reasons])
            if not reasons
            else f"type {name} is not known here, and its users do not describe it: "
            + "; ".join(reasons)
        )


def _servers_first(users: list[Endpoint]) -> list[Endpoint]:
    """Who publishes or serves is asked before who listens."""
    gives = (EndpointKind.PUBLISHER, EndpointKind.SERVICE)
    return sorted(users, key=lambda each: each.kind not in gives)


def _check_type(topic: str, given: str, found: list[Endpoint]) -> None:
    types = sorted({each.type_name for each in found})
    if types and given not in types:
        fail(f"{topic} is of type {', '.join(types)}, not {given}")


def _check_hash(name: str, of: list[Endpoint]) -> None:
    """Programs whose definitions differ exchange nothing: say so, loudly."""
    here = msgs.type_hash(name)
    for each in of:
        if each.type_name == name and each.type_hash not in ("", here):
            note(
                f"{each.node_full_name} has another definition of {name} "
                f"({each.type_hash[:17]}…, here {here[:17]}…): nothing it sends or "
                "takes can be read"
            )
