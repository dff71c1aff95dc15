"""Get, set, describe and dump the parameters of running nodes."""

from collections.abc import Iterable, Mapping, Sequence
from itertools import zip_longest
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from navette.cli.nearest import did_you_mean
from navette.cli.param.text import type_word
from navette.cli.service_calls import (
    ServiceRequest,
    call_all,
    response_of,
    response_timeout_s,
    served,
)
from navette.cli.session import fail, wait_for
from navette.errors import FileFormatError, ParameterError
from navette.files.writing import writing

if TYPE_CHECKING:
    from navette.runtime import Node, Parameter
    from navette.runtime.parameter_client import AsyncParameterClient


class ParameterNames(NamedTuple):
    """Parameter names by node, and reasons by node that did not respond."""

    found: dict[str, list[str]]
    unanswered: dict[str, str]


class ParameterDump(NamedTuple):
    """Values by node and name, and remarks on omitted ones."""

    found: dict[str, dict[str, Any]]
    remarks: list[str]


def names(
    here: "Node", nodes: Sequence[str], prefixes: Iterable[str] = ()
) -> ParameterNames:
    """Return the sorted parameter names of several nodes, with concurrent requests.

    Nodes without parameter services are left out.
    """
    fields = {"prefixes": list(prefixes)}
    found: dict[str, list[str]] = {}
    unanswered: dict[str, str] = {}
    there = served(here)
    nodes = [node for node in nodes if f"{node}/list_parameters" in there]
    answers = call_all(here, [_request(n, "list_parameters", fields) for n in nodes])
    for node, (response, reason) in zip(nodes, answers, strict=True):
        if response is None:
            unanswered[node] = reason
        else:
            found[node] = sorted(response.result.names)
    return ParameterNames(found, unanswered)


def types(
    here: "Node", found: Mapping[str, Sequence[str]]
) -> dict[tuple[str, str], str]:
    """Return ROS 2's name of each type by (node, name)."""
    nodes = [node for node in found if found[node]]
    answers = call_all(
        here,
        [_request(n, "get_parameter_types", {"names": list(found[n])}) for n in nodes],
    )
    kinds: dict[tuple[str, str], str] = {}
    for node, (response, _) in zip(nodes, answers, strict=True):
        given = list(response.types) if response is not None else []
        given += [0] * (len(found[node]) - len(given))
        for name, kind in zip(found[node], given, strict=False):
            kinds[node, name] = type_word(kind)
    return kinds


def held(
    here: "Node", found: Mapping[str, Sequence[str]]
) -> dict[tuple[str, str], str]:
    """Return values by (node, name) as in a parameter file; ``-`` if not set."""
    from navette.runtime.parameter import parameter_value_to_python
    from navette.runtime.parameter_files import format_value

    nodes = [node for node in found if found[node]]
    answers = call_all(
        here,
        [_request(n, "get_parameters", {"names": list(found[n])}) for n in nodes],
    )
    texts: dict[tuple[str, str], str] = {}
    for node, (response, _) in zip(nodes, answers, strict=True):
        values = list(response.values) if response is not None else []
        for name, value in zip_longest(found[node], values[: len(found[node])]):
            got = None if value is None else parameter_value_to_python(value)
            texts[node, name] = "-" if got is None else format_value(got)
    return texts


def get(here: "Node", node: str, wanted: Sequence[str]) -> "dict[str, Parameter[Any]]":
    """Return parameters of a node; the command fails if one does not exist."""
    found = _found(here, node, wanted)
    if len(found) != len(wanted):
        _fail_unknown(here, node, wanted)
    return found


def _found(
    here: "Node", node: str, wanted: Sequence[str]
) -> "dict[str, Parameter[Any]]":
    """Return all values; an empty dictionary if one of them does not exist."""
    from navette.runtime import Parameter
    from navette.runtime.parameter import ParameterType, parameter_value_to_python

    values = _answered(here, _client(here, node).get_parameters(list(wanted)), node)
    return {
        name: Parameter(
            name, ParameterType(value.type), parameter_value_to_python(value)
        )
        for name, value in zip(wanted, values.values, strict=False)
    }


def set_values(here: "Node", node: str, values: Mapping[str, Any]) -> list[Any]:
    """Set a node's parameters one by one; return a SetParametersResult for each.

    A value is converted to the declared type: an integer to a double, an empty list to
    a list of any type. For an unknown name the reason suggests similar names.
    """
    from navette.runtime import Parameter
    from navette.runtime.parameter import ParameterType, coerced

    client = _client(here, node)
    wanted = list(values)
    kinds = list(_answered(here, client.get_parameter_types(wanted), node).types)
    parameters = []
    for name, kind in zip(wanted, kinds or [0] * len(wanted), strict=True):
        value = values[name]
        parameter: Parameter[Any]
        try:
            declared = ParameterType(kind)
            parameter = Parameter(name, declared, coerced(name, value, declared))
        except (ParameterError, ValueError):
            # The node reports the error.
            parameter = Parameter(name, value=value)
        parameters.append(parameter)
    results = list(_answered(here, client.set_parameters(parameters), node).results)
    refused = {
        parameter.name: (parameter, result)
        for parameter, result in zip(parameters, results, strict=True)
        if not result.successful
    }
    if refused:
        _explain(here, node, refused)
    return results


def _explain(here: "Node", node: str, refused: Mapping[str, Any]) -> None:
    """Suggest similar names, and accept read-only parameters that have the value.

    A dump contains read-only parameters, and loading it should succeed.
    """
    known = names(here, [node]).found.get(node, [])
    there = _found(here, node, [name for name in refused if name in known])
    for name, (parameter, result) in refused.items():
        if name not in known and (hint := did_you_mean(name, known)):
            # Shorter than the node's list of all names.
            result.reason = f"node {node} has no parameter {name!r}{hint}"
        elif there.get(name) == parameter:
            result.successful, result.reason = True, "unchanged"


def delete(here: "Node", node: str, name: str) -> Any:
    """Delete a parameter; return the node's SetParametersResult."""
    client = _client(here, node)
    if name not in (known := names(here, [node]).found.get(node, [])):
        fail(f"node {node} has no parameter {name!r}{did_you_mean(name, known)}")
    return _answered(here, client.delete_parameters([name]), node).results[0]


def describe(here: "Node", node: str, wanted: Sequence[str]) -> list[Any]:
    """Return parameter descriptors; the command fails if one does not exist."""
    client = _client(here, node)
    response = _answered(here, client.describe_parameters(list(wanted)), node)
    if len(response.descriptors) != len(wanted):
        _fail_unknown(here, node, wanted)
    return list(response.descriptors)


def dump(here: "Node", nodes: Sequence[str]) -> ParameterDump:
    """Return all values that a parameter file can contain."""
    from navette.runtime.parameter import ParameterType, parameter_value_to_python

    listed = names(here, nodes)
    remarks = [f"{node}: {reason}" for node, reason in listed.unanswered.items()]
    requests = [
        _request(node, "get_parameters", {"names": found})
        for node, found in listed.found.items()
    ]
    values: dict[str, dict[str, Any]] = {}
    answers = call_all(here, requests)
    for (node, found), (response, reason) in zip(
        listed.found.items(), answers, strict=True
    ):
        if response is None:
            remarks.append(f"{node}: {reason}")
            continue
        values[node] = {}
        for name, value in zip(found, response.values, strict=False):
            kind = ParameterType(value.type)
            if kind in (ParameterType.NOT_SET, ParameterType.BYTE_ARRAY):
                remarks.append(
                    f"{node}: {name} omitted: YAML cannot represent {type_word(kind)}"
                )
            else:
                values[node][name] = parameter_value_to_python(value)
    return ParameterDump(values, remarks)


def as_file(values: Mapping[str, Mapping[str, Any]]) -> str:
    """Format values by node and name as a parameter file."""
    from navette.runtime.parameter_files import format_parameters

    return format_parameters(values)


def write(values: Mapping[str, Mapping[str, Any]], folder: Path) -> list[Path]:
    """Write a file per node, named as in ROS 2: ``ns__node.yaml`` for ``/ns/node``.

    Raises:
        FileFormatError: the folder is a file, or it cannot be written.
    """
    if folder.is_file():
        raise FileFormatError(folder, "is a file; expected a folder, new or existing")
    with writing(folder):
        folder.mkdir(parents=True, exist_ok=True)
    paths = []
    for node, own in values.items():
        path = folder / f"{node.strip('/').replace('/', '__')}.yaml"
        with writing(path):
            path.write_text(as_file({node: own}), encoding="utf-8")
        paths.append(path)
    return paths


def from_file(path: Path, node: str, *, use_wildcard: bool) -> dict[str, Any]:
    """Return a file's values for a node; the last matching entry wins."""
    from navette.runtime.overrides import ParameterOverrides

    overrides = ParameterOverrides()
    overrides.add_file(path)
    patterns = [each.pattern for each in overrides.sets]
    if not use_wildcard:
        overrides.sets = [each for each in overrides.sets if each.names_a_node]
    values = {name: each.value for name, each in overrides.for_node(node).items()}
    if not values:
        fail(
            f"{path} has no values for {node}, only for "
            f"{', '.join(patterns) or 'no node'}"
        )
    return values


def parsed(text: str) -> Any:
    """Parse a value as YAML."""
    from navette.runtime.parameter_files import parse_value

    return parse_value(text)


def quoting_hint(text: str) -> str:
    """Explain how to quote a string that YAML parses as another type."""
    return "" if isinstance(parsed(text), str) else f"; for a string: \"'{text}'\""


def _request(node: str, name: str, fields: dict[str, Any]) -> ServiceRequest:
    type_name = "".join(part.title() for part in name.split("_"))
    return ServiceRequest(f"{node}/{name}", f"rcl_interfaces/srv/{type_name}", fields)


def _client(here: "Node", node: str) -> "AsyncParameterClient":
    from navette.runtime.parameter_client import AsyncParameterClient

    client = AsyncParameterClient(here, node)
    if not client.wait_for_services(response_timeout_s()):
        fail(f"node {node} has no parameter services")
    return client


def _answered(here: "Node", future: Any, node: str) -> Any:
    wait_for(here, future.done, response_timeout_s())
    got = response_of(future, f"of {node}'s parameters")
    if got.response is None:
        fail(got.reason)
    return got.response


def _fail_unknown(here: "Node", node: str, wanted: Sequence[str]) -> None:
    """Fail with the name that the node does not have."""
    known = names(here, [node]).found.get(node, [])
    unknown = [name for name in wanted if name not in known]
    if not unknown:
        fail(f"node {node}: {', '.join(wanted)}: declared but not set")
    name = unknown[0]
    fail(f"node {node} has no parameter {name!r}{did_you_mean(name, known)}")
