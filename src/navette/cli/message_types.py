"""Find the type of a topic and its class: installed, from a peer or the workspace."""

from typing import Any

from navette import msgs
from navette.cli.nearest import did_you_mean, nearest
from navette.cli.peer_definitions import described_by_peers
from navette.cli.session import endpoints, fail, wait_for
from navette.cli.stderr import note
from navette.errors import InvalidNameError, NavetteError, UnknownNameError
from navette.msgs.registry import full_name, interface_names
from navette.runtime import Node
from navette.transports import Endpoint, EndpointKind


def topic_class(
    node: Node, topic: str, type_name: str | None = None, timeout_s: float | None = None
) -> Any:
    """Return the message class of a topic, by default of the type in use.

    Waits for the first endpoint of the topic. The command fails if several types are
    published, the topic has another type than given, or no endpoint before the timeout.
    """
    name = node.resolve_topic_name(topic)
    if type_name is not None:
        cls = interface_class(node, type_name, endpoints(node, name), kind="msg")
        _check_type(name, msgs.type_name(cls), endpoints(node, name))
        return cls
    if not endpoints(node, name):
        near = did_you_mean(name, (each.topic for each in endpoints(node)))
        note(f"waiting for a publisher on {name}{near}")
        if not wait_for(node, lambda: bool(endpoints(node, name)), timeout_s):
            fail(f"no publisher on {name} in {timeout_s:g} s")
    found = endpoints(node, name)
    types = _types_in_use(found)
    if len(types) > 1:
        fail(f"{name} has several types ({', '.join(types)}): give one after the name")
    return interface_class(node, types[0], found, kind="msg")


def _types_in_use(found: list[Endpoint]) -> list[str]:
    """Return the types that are published; without publishers, those subscribed to."""
    published = {e.type_name for e in found if e.kind == EndpointKind.PUBLISHER}
    return sorted(published or {each.type_name for each in found})


def interface_class(
    node: Node, type_name: str, of: list[Endpoint], *, kind: str = ""
) -> Any:
    """Return the class of a type: known here, described by a peer, or in the workspace.

    Args:
        of: endpoints of the topic or service, whose nodes provide the definition.
        kind: ``msg``, ``srv`` or ``action``, to expand ``pkg/Name``.
    """
    name = full_type_name(type_name, kind)
    if kind and name.split("/")[1] != kind:
        raise InvalidNameError(f"type {type_name!r} is not package/{kind}/Name")
    try:
        cls = msgs.get_interface(name)
    except UnknownNameError:
        return _class_from_outside(node, name, of)
    _check_hash(name, of)
    return cls


def full_type_name(type_name: str, kind: str) -> str:
    """Expand ``pkg/Name`` to ``pkg/<kind>/Name``; full names are unchanged.

    Raises:
        InvalidNameError: neither of the two forms.
    """
    package, _, rest = type_name.partition("/")
    return full_name(
        f"{package}/{kind}/{rest}" if kind and "/" not in rest else type_name
    )


def installed_class(name: str) -> Any:
    """Return the class of an installed or workspace type; None if there is none."""
    from navette.ros2.workspace import activate

    for look_further in (lambda: None, activate):
        look_further()
        try:
            return msgs.get_interface(name)
        except UnknownNameError:
            pass
    return None


def _class_from_outside(node: Node, name: str, of: list[Endpoint]) -> Any:
    definition = described_by_peers(node, name, of)
    reason = definition.reason
    if definition.text is not None:
        try:
            cls = msgs.register_definition(name, definition.text)
            _check_hash(name, of)
            return cls
        except NavetteError as error:
            reason = str(error)
    found = installed_class(name)
    if found is None:
        fail(
            f"type {name} is not installed"
            + (
                f", and the nodes that use it do not describe it ({reason})"
                if reason
                else near_types(name)
            )
        )
    return found


def if_unknown(name: str) -> str:
    """Suggest similar types if the type is not installed."""
    return "" if installed_class(name) is not None else near_types(name)


def near_types(name: str) -> str:
    """Suggest types of the same package, or the same name in other packages.

    For a name without a package, types of similar names are suggested as well.
    """
    *rest, last = name.split("/")
    every = (
        (package, f"{package}/{kind}/{each}")
        for package in msgs.packages()
        for kind in ("msg", "srv", "action")
        for each in interface_names(package, kind)
    )
    if rest and rest[0] in msgs.packages():
        return did_you_mean(name, (full for of, full in every if of == rest[0]))
    full_names = [full for _, full in every]
    similar = [] if rest else nearest(last, (f.rpartition("/")[2] for f in full_names))
    for each in (last, *similar):
        same = f"/{each}".lower()
        found = [full for full in full_names if full.lower().endswith(same)]
        if found:
            return did_you_mean(f"/{each}", found)
    return ""


def _check_type(topic: str, given: str, found: list[Endpoint]) -> None:
    types = sorted({each.type_name for each in found})
    if types and given not in types:
        fail(f"{topic} has type {', '.join(types)}, not {given}")


def _check_hash(name: str, of: list[Endpoint]) -> None:
    """Report nodes whose definition of the type differs: they cannot communicate."""
    here = msgs.type_hash(name)
    for each in of:
        if each.type_name == name and each.type_hash not in ("", here):
            note(
                f"{each.node_full_name} has another definition of {name} "
                f"({each.type_hash[:17]}…, here {here[:17]}…): messages cannot be "
                "exchanged with it"
            )
