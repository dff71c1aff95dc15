"""Request type definitions from other nodes (``~/get_type_description``)."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from navette.cli.output import harmless
from navette.cli.session import endpoints, service_endpoints
from navette.errors import NavetteError
from navette.msgs.interface import short_name
from navette.runtime import Node
from navette.transports import Endpoint, EndpointKind

ANSWER_TIMEOUT_S = 2.0
_SERVICE = "get_type_description"
_SEPARATOR = "=" * 80
_MOST_TYPES = 500

# Constants of type_description_interfaces/msg/FieldType: scalars, offsets of arrays.
_SCALARS = {
    2: "int8", 3: "uint8", 4: "int16", 5: "uint16", 6: "int32", 7: "uint32",
    8: "int64", 9: "uint64", 10: "float32", 11: "float64", 13: "char", 15: "bool",
    16: "byte", 17: "string", 18: "wstring", 21: "string", 22: "wstring",
}  # fmt: skip
_NESTED = 1
_BOUNDED_STRINGS = (21, 22)
_ARRAY, _BOUNDED_SEQUENCE, _SEQUENCE = 48, 96, 144
# Serialized empty definitions have this member.
_PLACEHOLDER = "structure_needs_at_least_one_member"


@dataclass(frozen=True)
class Definition:
    """A definition for ``register_definition``, or the reason for its absence."""

    text: str | None
    reason: str = ""


def described_by_peers(node: Node, type_name: str, of: list[Endpoint]) -> Definition:
    """Return the first definition from the nodes that use the type.

    Publishers and servers are asked before subscribers and clients, and nodes that use
    the type on other topics last. Peers that are not ROS nodes have no definition.
    """
    users = _users(type_name, of)
    hashes = {each.type_hash for each in users}
    everywhere = [*endpoints(node), *service_endpoints(node)]
    others = _users(type_name, everywhere)
    users += [each for each in others if not hashes or each.type_hash in hashes]
    reasons = []
    for name in dict.fromkeys(each.node_full_name for each in users):
        definition = fetch_definition(node, name, type_name)
        if definition.text is not None:
            return definition
        reasons.append(f"{name}: {definition.reason}")
    return Definition(None, "; ".join(reasons))


def _users(type_name: str, of: list[Endpoint]) -> list[Endpoint]:
    gives = (EndpointKind.PUBLISHER, EndpointKind.SERVICE)
    # Endpoints of an action have the types of its parts: pkg/action/Name_SendGoal.
    users = [e for e in of if f"{e.type_name}_".startswith(f"{type_name}_")]
    return sorted(users, key=lambda each: each.kind not in gives)


def fetch_definition(node: Node, of: str, type_name: str) -> Definition:
    """Ask the node called ``of`` for the definition of a type that it uses."""
    from navette.msgs.type_description_interfaces.srv import GetTypeDescription

    service = f"{of}/{_SERVICE}"
    graph = node.context.graph
    if not graph.service_endpoints(service, kind=EndpointKind.SERVICE):
        return Definition(None, "describes no types")
    hashes = {
        each.type_hash
        for each in (*graph.endpoints(node=of), *graph.service_endpoints(node=of))
        if each.type_name == type_name
    }
    request = GetTypeDescription.Request(
        type_name=type_name, type_hash=next(iter(hashes), ""), include_type_sources=True
    )
    client = node.create_client(GetTypeDescription, service)
    try:
        response = client.call(request, timeout_sec=ANSWER_TIMEOUT_S)
    except TimeoutError:
        return Definition(None, f"no response in {ANSWER_TIMEOUT_S:g} s")
    except NavetteError as error:
        return Definition(None, str(error))
    finally:
        client.destroy()
    if not response.successful:
        return Definition(None, harmless(response.failure_reason[:200]) or "refused")
    return Definition(definition_of(type_name, response))


def definition_of(type_name: str, response: Any) -> str:
    """Return the text of a definition from a response: its source if included.

    Without the source, constants and defaults are missing.
    """
    sources = {
        source.type_name: source.raw_file_contents
        for source in response.type_sources[:_MOST_TYPES]
        if source.encoding in ("msg", "srv", "action") and source.raw_file_contents
    }
    described = response.type_description
    every = [described.type_description]
    every += described.referenced_type_descriptions[:_MOST_TYPES]
    parts = {each.type_name: each for each in every}
    top = sources.get(type_name)
    if top is None:
        top = "---\n".join(map(_fields_text, _tops(type_name, parts)))
    texts = [top]
    for name, part in parts.items():
        if _is_message(name) and name != type_name:
            body = sources.get(name) or _fields_text(part)
            texts.append(f"{_SEPARATOR}\nMSG: {short_name(name)}\n{body}")
    return "".join(text.rstrip("\n") + "\n" for text in texts)


def _is_message(name: str) -> bool:
    return name.split("/")[1:2] == ["msg"]


def _tops(type_name: str, parts: dict[str, Any]) -> list[Any]:
    """Return the message, or the parts of a service or action."""
    endings: Sequence[str] = {
        "srv": ("_Request", "_Response"),
        "action": ("_Goal", "_Result", "_Feedback"),
    }.get(type_name.split("/")[1], ("",))
    return [parts[type_name + end] for end in endings if type_name + end in parts]


def _fields_text(description: Any) -> str:
    lines: Iterable[str] = (
        f"{_type_text(field.type)} {field.name}\n"
        for field in description.fields
        if field.name != _PLACEHOLDER
    )
    return "".join(lines)


def _type_text(type_: Any) -> str:
    for offset in (_SEQUENCE, _BOUNDED_SEQUENCE, _ARRAY, 0):
        if type_.type_id > offset:
            break
    scalar = type_.type_id - offset
    if scalar == _NESTED:
        base = short_name(type_.nested_type_name)
    else:
        base = _SCALARS.get(scalar, f"unknown_type_{type_.type_id}")
    if scalar in _BOUNDED_STRINGS:
        base += f"<={type_.string_capacity}"
    if offset == 0:
        return base
    size = {_SEQUENCE: "", _BOUNDED_SEQUENCE: f"<={type_.capacity}"}
    return f"{base}[{size.get(offset, type_.capacity)}]"
