"""The verbs of ``navette param``."""

import re
from pathlib import Path
from typing import Annotated, Any

import click

from navette.cli.commands import Group
from navette.cli.completing import complete_parameter_value
from navette.cli.options import Argument, HiddenNodes, Json, Option
from navette.cli.output import harmless, is_terminal, show, show_json, styled
from navette.cli.param import text, values
from navette.cli.param.options import AnyNode, Name, Names, NodeName, Timeout
from navette.cli.service_calls import (
    RESPONSE_TIMEOUT_S,
    chosen_node,
    node_names,
    response_timeout,
)
from navette.cli.session import connect, fail
from navette.cli.stderr import note
from navette.errors import InvalidValueError

param = Group(
    name="param",
    help="Get, set, list, describe, dump and load parameters of nodes.",
)


@param.command("list")
def list_(
    node_name: AnyNode = None,
    filter_: Annotated[
        str | None,
        Option("--filter", metavar="REGEX", help="List only matching names."),
    ] = None,
    prefixes: Annotated[
        list[str] | None,
        Option(
            "--param-prefixes",
            "--prefixes",
            metavar="PREFIX...",
            takes_words=True,
            help="List only names with these prefixes, such as limits for"
            " limits.max_speed_mps.",
        ),
    ] = None,
    types: Annotated[
        bool, Option("--param-type", help="Also print the types.")
    ] = False,
    include_hidden_nodes: HiddenNodes = False,
    timeout_s: Timeout = RESPONSE_TIMEOUT_S,
    as_json: Json = False,
) -> None:
    """List the parameters of a node or of all nodes."""
    pattern = _pattern(filter_)
    with connect() as here, response_timeout(timeout_s):
        every = node_names(here, hidden=include_hidden_nodes)
        nodes = [chosen_node(here, node_name)] if node_name else every
        listed = values.names(here, nodes, prefixes or ())
        for name, reason in listed.unanswered.items():
            note(f"{name}: {reason}")
        if node_name and nodes[0] not in {**listed.found, **listed.unanswered}:
            fail(f"node {nodes[0]} has no parameter services")
        found = {
            node: [name for name in names if pattern is None or pattern.match(name)]
            for node, names in listed.found.items()
        }
        kinds = values.types(here, found) if types else {}
        held = values.held(here, found) if is_terminal() and not as_json else {}
    if as_json:
        show_json(
            {
                node: {n: kinds[node, n] for n in names} if types else names
                for node, names in found.items()
            }
        )
    else:
        for line in text.name_lines(found, kinds, held, with_nodes=node_name is None):
            show(line)
    if node_name and listed.unanswered:
        raise click.exceptions.Exit(1)


def _pattern(text: str | None) -> re.Pattern[str] | None:
    if text is None:
        return None
    try:
        return re.compile(text)
    except re.error as error:
        raise InvalidValueError(
            f"--filter {text!r} is not a regular expression: {error}"
        ) from None


@param.command()
def get(
    node_name: NodeName,
    name: Name,
    hide_type: Annotated[
        bool, Option("--hide-type", help="Print only the value.")
    ] = False,
    timeout_s: Timeout = RESPONSE_TIMEOUT_S,
    as_json: Json = False,
) -> None:
    """Print the value of a parameter."""
    with connect() as here, response_timeout(timeout_s):
        node = chosen_node(here, node_name)
        got = values.get(here, node, [name])[name]
    if as_json:
        show_json(text.plain(got))
    elif hide_type:
        show(harmless(str(got.value)))
    else:
        show(harmless(text.labelled(got)))


@param.command("set", context_settings={"ignore_unknown_options": True})
def set_(
    node_name: NodeName,
    name: Name,
    value: Annotated[
        str,
        Argument(
            metavar="VALUE",
            help="YAML value: 1.5, true, text, \"'5'\", [1, 2].",
            complete=complete_parameter_value,
        ),
    ],
    timeout_s: Timeout = RESPONSE_TIMEOUT_S,
) -> None:
    """Set a parameter of a running node.

    An integer is accepted for a double. If the node rejects the value, the reason is
    printed and the exit code is 1.
    """
    with connect() as here, response_timeout(timeout_s):
        node = chosen_node(here, node_name)
        result = values.set_values(here, node, {name: values.parsed(value)})[0]
    if not result.successful:
        hint = values.quoting_hint(value) if "expected STRING" in result.reason else ""
        fail(_with_reason("Setting parameter failed", result) + hint)
    show(_with_reason("Set parameter successful", result))


@param.command()
def describe(
    node_name: NodeName,
    names: Names,
    timeout_s: Timeout = RESPONSE_TIMEOUT_S,
    as_json: Json = False,
) -> None:
    """Show description, type and limits of parameters."""
    with connect() as here, response_timeout(timeout_s):
        node = chosen_node(here, node_name)
        described = values.describe(here, node, names)
    if as_json:
        show_json([text.descriptor_dict(each) for each in described])
        return
    for each in described:
        show(styled(f"Parameter name: {each.name}", bold=True))
        for line in text.descriptor_lines(each):
            show(harmless(line))


@param.command()
def dump(
    node_name: AnyNode = None,
    output_dir: Annotated[
        Path | None,
        Option(
            "--output-dir",
            "-o",
            metavar="FOLDER",
            help="Write one file per node to this folder instead of printing.",
        ),
    ] = None,
    include_hidden_nodes: HiddenNodes = False,
    timeout_s: Timeout = RESPONSE_TIMEOUT_S,
) -> None:
    """Print the parameters of a node, or of all nodes, as a parameter file.

    The file works with --params-file, in launch files and with navette param load.
    """
    with connect() as here, response_timeout(timeout_s):
        every = node_names(here, hidden=include_hidden_nodes)
        nodes = [chosen_node(here, node_name)] if node_name else every
        dumped = values.dump(here, nodes)
        for remark in dumped.remarks:
            note(remark)
    if output_dir is None:
        show(values.as_file(dumped.found).rstrip("\n"))
    else:
        for path in values.write(dumped.found, output_dir):
            show(f"Saving to: {path}")
    if dumped.remarks and not dumped.found:
        raise click.exceptions.Exit(1)


@param.command()
def load(
    node_name: NodeName,
    parameter_file: Annotated[
        Path, Argument(metavar="FILE", help="ROS 2 parameter file.")
    ],
    no_use_wildcard: Annotated[
        bool, Option("--no-use-wildcard", help="Ignore the values under /**.")
    ] = False,
    timeout_s: Timeout = RESPONSE_TIMEOUT_S,
) -> None:
    """Set the parameters of a node from a parameter file."""
    with connect() as here, response_timeout(timeout_s):
        node = chosen_node(here, node_name)
        wanted = values.from_file(
            parameter_file, node, use_wildcard=not no_use_wildcard
        )
        results = values.set_values(here, node, wanted)
    failed = False
    for name, result in zip(wanted, results, strict=True):
        if result.successful:
            show(_with_reason(f"Set parameter {name} successful", result))
        else:
            failed = True
            note(_with_reason(f"Set parameter {name} failed", result))
    if failed:
        raise click.exceptions.Exit(1)


@param.command()
def delete(
    node_name: NodeName, name: Name, timeout_s: Timeout = RESPONSE_TIMEOUT_S
) -> None:
    """Delete a parameter; nodes allow it only for parameters without a fixed type."""
    with connect() as here, response_timeout(timeout_s):
        node = chosen_node(here, node_name)
        result = values.delete(here, node, name)
    if not result.successful:
        fail(_with_reason("Deleting parameter failed", result))
    show(_with_reason("Deleted parameter successfully", result))


def _with_reason(text: str, result: Any) -> str:
    return f"{text}: {harmless(result.reason)}" if result.reason else text
