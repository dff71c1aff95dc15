"""``navette param``: texts as of ros2 param, refusals, files that go round."""

import json
from collections.abc import Iterator
from pathlib import Path

import pytest
from verb_world import World, world

from navette.msgs.rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from navette.runtime import Node, Parameter
from navette.runtime.parameter_files import parse_parameters

DUMP = """\
/driver:
  ros__parameters:
    limits:
      max: 2.5
    names:
    - left
    - right
    rate: 10
    start_type_description_service: true
    topic: 'on'
    use_sim_time: false
"""


@pytest.fixture
def driver(here: World) -> Node:
    driver = here.graph.add(Node("driver", context=here.context))
    limits = ParameterDescriptor(
        description="Fastest.",
        floating_point_range=[FloatingPointRange(from_value=0.0, to_value=5.0)],
    )
    driver.declare_parameter("limits.max", 2.5, limits)
    driver.declare_parameter("rate", 10)
    driver.declare_parameter("topic", "on")
    driver.declare_parameter("names", ["left", "right"])
    return driver


@pytest.fixture
def here() -> Iterator[World]:
    with world() as here:
        yield here


def test_list(here: World, driver: Node) -> None:
    here.graph.add(Node("other", context=here.context))
    of_driver = (
        "  limits.max\n  names\n  rate\n  start_type_description_service\n"
        "  topic\n  use_sim_time\n"
    )
    of_other = "  start_type_description_service\n  use_sim_time\n"
    assert here.read("param", "list", "driver") == of_driver
    both = f"/driver:\n{of_driver}/other:\n{of_other}"
    assert here.read("param", "list") == both
    assert here.read("param", "list", "driver", "--filter", "r.*") == "  rate\n"
    by_prefix = here.read("param", "list", "--prefixes", "limits", "topic")
    assert by_prefix == "/driver:\n  limits.max\n  topic\n"


def test_list_with_types(here: World, driver: Node) -> None:
    shown = here.read("param", "list", "driver", "--param-type", "--filter", "[lnrtu]")
    assert shown.splitlines() == [
        "  limits.max (type: double)",
        "  names (type: string array)",
        "  rate (type: integer)",
        "  topic (type: string)",
        "  use_sim_time (type: boolean)",
    ]


def test_a_text_that_yaml_reads_otherwise(here: World, driver: Node) -> None:
    done = here.run("param", "set", "driver", "topic", "5")
    assert done.code == 1
    assert done.err.endswith("""5 is INTEGER, expected STRING; for a string: "'5'"\n""")
    here.read("param", "set", "driver", "topic", "'5'")
    assert driver.get_parameter("topic").value == "5"


def test_a_wrong_pattern_is_a_usage_error(here: World) -> None:
    done = here.run("param", "list", "--filter", "(")
    assert done.code == 2
    assert "--filter '('" in done.err


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("limits.max", "Double value is: 2.5"),
        ("rate", "Integer value is: 10"),
        ("topic", "String value is: on"),
        ("names", "String values are: ['left', 'right']"),
        ("use_sim_time", "Boolean value is: False"),
    ],
)
def test_get(here: World, driver: Node, name: str, text: str) -> None:
    assert here.read("param", "get", "/driver", name) == f"{text}\n"


def test_get_only_the_value(here: World, driver: Node) -> None:
    assert here.read("param", "get", "driver", "limits.max", "--hide-type") == "2.5\n"
    assert json.loads(here.read("param", "get", "driver", "names", "--json")) == [
        "left",
        "right",
    ]


def test_set_takes_an_integer_for_a_double(here: World, driver: Node) -> None:
    printed = here.read("param", "set", "driver", "limits.max", "3")
    assert printed == "Set parameter successful\n"
    assert driver.get_parameter("limits.max").value == 3.0


@pytest.mark.parametrize(
    ("name", "value", "reason"),
    [
        ("rate", "2.5", "parameter 'rate': 2.5 is DOUBLE, expected INTEGER"),
        ("limits.max", "7", "parameter 'limits.max': 7.0 is out of range 0 … 5"),
        ("limits.max", "-1", "parameter 'limits.max': -1.0 is out of range 0 … 5"),
    ],
)
def test_set_prints_why_a_value_was_rejected(
    here: World, driver: Node, name: str, value: str, reason: str
) -> None:
    before = driver.get_parameter(name).value
    done = here.run("param", "set", "driver", name, value)
    assert (done.out, done.code) == ("", 1)
    assert done.err == f"navette: Setting parameter failed: {reason}\n"
    assert driver.get_parameter(name).value == before


@pytest.mark.parametrize("verb", ["get", "set", "describe", "delete"])
def test_a_mistyped_parameter(here: World, driver: Node, verb: str) -> None:
    value = ["1"] if verb == "set" else []
    done = here.run("param", verb, "driver", "limit.max", *value)
    assert (done.out, done.code) == ("", 1)
    assert done.err.endswith("; did you mean limits.max?\n")


def test_describe(here: World, driver: Node) -> None:
    shown = here.read("param", "describe", "driver", "limits.max", "topic")
    assert shown == (
        "Parameter name: limits.max\n"
        "  Type: double\n"
        "  Description: Fastest.\n"
        "  Constraints:\n"
        "    Min value: 0.0\n"
        "    Max value: 5.0\n"
        "Parameter name: topic\n"
        "  Type: string\n"
        "  Constraints:\n"
    )


def test_dump_goes_round(here: World, driver: Node, tmp_path: Path) -> None:
    text = here.read("param", "dump", "driver")
    assert text == DUMP
    here.read("param", "dump", "-o", str(tmp_path))
    file = tmp_path / "driver.yaml"
    assert file.read_text() == DUMP
    driver.set_parameters([Parameter("rate", value=1), Parameter("topic", value="x")])
    printed = here.read("param", "load", "driver", str(file))
    assert "Set parameter rate successful\n" in printed
    assert here.read("param", "dump", "driver") == DUMP
    with_file = Node(
        "driver",
        namespace="/again",
        context=here.context,
        cli_args=["--params-file", str(_for_node(file, "/again/driver"))],
        automatically_declare_parameters_from_overrides=True,
    )
    assert with_file.get_parameter("topic").value == "on"
    assert with_file.get_parameter("names").value == ["left", "right"]


def _for_node(file: Path, node: str) -> Path:
    renamed = file.with_name("renamed.yaml")
    renamed.write_text(file.read_text().replace("/driver:", f"{node}:"))
    return renamed


def test_dump_into_a_file_instead_of_a_folder_is_refused(
    here: World, driver: Node, tmp_path: Path
) -> None:
    file = tmp_path / "driver.yaml"
    file.write_text("kept", encoding="utf-8")
    refused = here.run("param", "dump", "-o", str(file))
    assert (refused.code, "expected a folder" in refused.err) == (2, True)
    below = here.run("param", "dump", "-o", str(file / "folder"))
    assert (below.code, "cannot be written: Not a dir" in below.err) == (2, True)
    assert file.read_text(encoding="utf-8") == "kept"


def test_dump_of_all_nodes_is_one_file(here: World, driver: Node) -> None:
    here.graph.add(Node("other", context=here.context))
    patterns = [name for name, _ in parse_parameters(here.read("param", "dump"))]
    assert patterns == ["/driver", "/other"]


def test_load_uses_the_entries_of_the_node(
    here: World, driver: Node, tmp_path: Path
) -> None:
    file = tmp_path / "stack.yaml"
    file.write_text(
        "/**: {ros__parameters: {rate: 5}}\n"
        "driver: {ros__parameters: {topic: scan}}\n"
        "planner: {ros__parameters: {tolerance: 0.5}}\n"
    )
    assert here.read("param", "load", "driver", str(file)) == (
        "Set parameter rate successful\nSet parameter topic successful\n"
    )
    assert driver.get_parameter("rate").value == 5
    done = here.run("param", "load", "driver", str(file), "--no-use-wildcard")
    assert done.out == "Set parameter topic successful\n"


def test_load_fails_where_a_value_is_refused(
    here: World, driver: Node, tmp_path: Path
) -> None:
    file = tmp_path / "stack.yaml"
    file.write_text("driver: {ros__parameters: {rate: fast, topic: scan}}\n")
    done = here.run("param", "load", "driver", str(file))
    assert done.code == 1
    assert done.out == "Set parameter topic successful\n"
    assert done.err.startswith("Set parameter rate failed: parameter 'rate': 'fast'")


def test_load_of_a_file_without_values_for_the_node(
    here: World, driver: Node, tmp_path: Path
) -> None:
    file = tmp_path / "stack.yaml"
    file.write_text("planner: {ros__parameters: {tolerance: 0.5}}\n")
    done = here.run("param", "load", "driver", str(file))
    assert done.code == 1
    assert done.err == (
        f"navette: {file} has no values for /driver, only for /planner\n"
    )


def test_delete(here: World, driver: Node) -> None:
    driver.declare_parameter("any")
    driver.set_parameters([Parameter("any", value=1)])
    assert here.read("param", "delete", "driver", "any") == (
        "Deleted parameter successfully\n"
    )
    assert not driver.has_parameter("any")
    done = here.run("param", "delete", "driver", "rate")
    assert done.code == 1
    assert "static parameter 'rate' cannot be undeclared" in done.err


def test_a_node_without_parameter_services(here: World) -> None:
    node = Node("plain", context=here.context, start_parameter_services=False)
    here.graph.add(node)
    done = here.run("param", "get", "plain", "rate")
    assert (done.code, done.err) == (
        1,
        "navette: node /plain has no parameter services\n",
    )
    assert here.run("param", "list", "plain") == done._replace(out="")
    assert here.run("param", "list") == ("", "", 0)
    assert here.graph.now_ns == 2_000_000_000  # get waits for them, list does not


def test_a_node_that_hangs_is_named(here: World, driver: Node) -> None:
    """A node without an executor is in the graph but does not respond."""
    here.graph.executor.remove_node(driver)
    done = here.run("param", "list")
    assert done.out == ""
    assert done.err == "/driver: service /driver/list_parameters: no response\n"


def test_a_parameter_without_a_value(here: World, driver: Node) -> None:
    driver.declare_parameter("mode", Parameter.Type.STRING)
    done = here.run("param", "get", "driver", "mode")
    assert done.err == "navette: node /driver: mode: declared but not set\n"
    done = here.run("param", "set", "driver", "mode", "5")
    assert "parameter 'mode': 5 is INTEGER, expected STRING" in done.err
    assert here.read("param", "set", "driver", "mode", "fast")
