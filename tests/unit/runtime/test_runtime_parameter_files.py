"""Parameter files and arguments: format, matching, precedence, errors."""

from pathlib import Path
from typing import Any

import pytest

from navette.errors import FileFormatError, InvalidValueError, ParameterError
from navette.runtime import Context, Node, VirtualClock
from navette.runtime.arguments import parse_ros_arguments, remove_ros_args
from navette.runtime.exceptions import RCLError, UnknownROSArgsError
from navette.runtime.log_levels import LoggingSeverity
from navette.runtime.overrides import ParameterOverrides
from navette.runtime.parameter_files import (
    format_parameters,
    parse_parameters,
    parse_value,
    read_parameter_file,
)

FILE = """
planner:
  ros__parameters:
    method: astar
    tolerance: 0.5
    footprint_m: [0.5, 0.5, -0.5, 0.5]
    nested:
      depth.of: {it: 3}
/robot:
  control:
    ros__parameters: {gain: 2, names: [a, b]}
/**:
  ros__parameters:
    use_sim_time: true
"""


def test_nodes_and_nested_names() -> None:
    assert parse_parameters(FILE) == [
        (
            "/planner",
            {
                "method": "astar",
                "tolerance": 0.5,
                "footprint_m": [0.5, 0.5, -0.5, 0.5],
                "nested.depth.of.it": 3,
            },
        ),
        ("/robot/control", {"gain": 2, "names": ["a", "b"]}),
        ("/**", {"use_sim_time": True}),
    ]


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1", 1),
        ("-0x10", -16),
        ("010", 8),
        ("08", 8.0),
        ("0o17", "0o17"),
        ("99999999999999999999", 1e20),
        ("1e400", "1e400"),
        ('!!int "5"', "5"),
        ("1.0", 1.0),
        ("1e5", 1e5),
        ("1.5e-3", 1.5e-3),
        (".5", 0.5),
        ("-.inf", float("-inf")),
        ("true", True),
        ("off", False),
        ("text", "text"),
        ("'1'", "1"),
        ("2001-01-01", "2001-01-01"),
        ("1:30", "1:30"),
        ("[1, 2.5]", [1.0, 2.5]),
        ("[]", []),
        ("a: b: c", "a: b: c"),
        ("/scan", "/scan"),
        ("", ""),
        ("null", "null"),
    ],
)
def test_scalars_as_in_ros(text: str, value: Any) -> None:
    parsed = parse_value(text)
    assert parsed == value
    assert type(parsed) is type(value)


@pytest.mark.parametrize(
    "text", ["{a: 1}", "[1, a]", "[[1]]", "[1, true]", "[null]", "!!binary aGk="]
)
def test_values_without_a_parameter_type(text: str) -> None:
    with pytest.raises(ParameterError, match="not a parameter value"):
        parse_value(text)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("a: [1", "not YAML"),
        ("- 1", "node_name"),
        ("node: 3", "ros__parameters"),
        ("node: {ros__parameters: 3}", "name: value"),
        ("a: &x [1, *x]", "contains itself"),
        ("n: {ros__parameters: &x {b: *x}}", "contains itself"),
        ("[" * 1000, "nested too deeply|not YAML"),
        ("!!python/object/apply:os.system ['true']", "not YAML"),
    ],
)
def test_invalid_and_malicious_files(text: str, reason: str) -> None:
    with pytest.raises(FileFormatError, match=reason):
        parse_parameters(text, "some.yaml")


def test_alias_bomb_ends_early() -> None:
    lines = ["a0: &a0 {x: 1, y: 2}"]
    for i in range(1, 25):
        lines.append(f"a{i}: &a{i} {{l: *a{i - 1}, r: *a{i - 1}}}")
    body = "\n".join(f"    {line}" for line in lines)
    with pytest.raises(FileFormatError, match="more than"):
        parse_parameters(f"n:\n  ros__parameters:\n{body}\n")


def test_names_are_always_text() -> None:
    found = parse_parameters("n:\n  ros__parameters: {y: 1, on: {off: 2}, 3: 4}")
    assert found == [("/n", {"y": 1, "on.off": 2, "3": 4})]


def test_error_names_file_and_line(tmp_path: Path) -> None:
    path = tmp_path / "bad.yaml"
    path.write_text("a:\n  b: [1\n  c: 2\n", encoding="utf-8")
    with pytest.raises(FileFormatError) as caught:
        read_parameter_file(path)
    assert caught.value.path == path
    assert caught.value.line is not None
    with pytest.raises(FileFormatError, match="cannot be read"):
        read_parameter_file(tmp_path / "missing.yaml")


@pytest.mark.parametrize(
    ("pattern", "node", "fits"),
    [
        ("planner", "/planner", True),
        ("/planner", "/planner", True),
        ("planner", "/robot/planner", False),
        ("/robot/planner", "/robot/planner", True),
        ("/**", "/a/b/c", True),
        ("/**/planner", "/planner", True),
        ("/**/planner", "/a/b/planner", True),
        ("/*/planner", "/a/planner", True),
        ("/*/planner", "/a/b/planner", False),
        ("/robot*/planner", "/robot7/planner", True),
        ("/a.b", "/axb", False),
    ],
)
def test_patterns(pattern: str, node: str, fits: bool) -> None:
    overrides = ParameterOverrides()
    overrides.add(pattern, {"x": 1}, "test")
    assert ("x" in overrides.for_node(node)) is fits


def make_node(args: list[str], name: str = "planner", **kwargs: Any) -> Node:
    context = Context(clock=VirtualClock())
    context.init(["--ros-args", *args])
    return Node(name, context=context, **kwargs)


def test_the_last_value_counts(tmp_path: Path) -> None:
    first, second = tmp_path / "1.yaml", tmp_path / "2.yaml"
    first.write_text("planner: {ros__parameters: {a: 1, b: 1, c: 1}}")
    second.write_text("/**: {ros__parameters: {b: 2, c: 2}}")
    node = make_node(
        ["--params-file", str(first), "--params-file", str(second), "-p", "c:=3"]
    )
    values = [node.declare_parameter(name, 0).value for name in "abcd"]
    assert values == [1, 2, 3, 0]


def test_a_parameter_for_a_node_by_its_base_name() -> None:
    node = make_node(["-p", "planner:x:=1", "-p", "other:y:=1"], namespace="/robot")
    assert node.declare_parameter("x", 0).value == 1
    assert node.declare_parameter("y", 0).value == 0


def test_an_int_in_a_file_is_converted_to_a_double() -> None:
    value = make_node(["-p", "x:=1"]).declare_parameter("x", 0.5).value
    assert isinstance(value, float)


def test_the_error_of_a_wrong_type_names_node_parameter_and_origin() -> None:
    node = make_node(["-p", "x:=fast"])
    with pytest.raises(
        ParameterError, match=r"/planner.*'x'.*'fast'.*DOUBLE.*command line -p x"
    ):
        node.declare_parameter("x", 0.5)


def test_the_check_passes_with_known_parameters() -> None:
    node = make_node(["-p", "x:=1", "-p", "planner:y:=1"])
    node.declare_parameters("", [("x", 0), ("y", 0)])
    node.context.check_overrides()


def test_the_check_names_unknown_and_known_parameters() -> None:
    node = make_node(["-p", "planner:sped:=1"])
    node.declare_parameter("speed", 0)
    with pytest.raises(ParameterError, match=r"-p planner:sped.*'sped'.*speed"):
        node.context.check_overrides()


def test_the_check_names_files_without_a_matching_node(tmp_path: Path) -> None:
    path = tmp_path / "robot.yaml"
    path.write_text("planer: {ros__parameters: {x: 1}}")
    node = make_node(["--params-file", str(path)])
    with pytest.raises(ParameterError, match=r"robot.yaml: no node matches.*/planner"):
        node.context.check_overrides()


def test_values_for_all_nodes_require_one_node_with_the_parameter() -> None:
    node = make_node(["-p", "x:=1"])
    other = Node("other", context=node.context)
    with pytest.raises(ParameterError, match="unknown parameter 'x'"):
        node.context.check_overrides([node, other])
    other.declare_parameter("x", 0)
    node.context.check_overrides([node, other])


def test_a_node_with_undeclared_parameters_passes() -> None:
    make_node(
        ["-p", "x:=1"], allow_undeclared_parameters=True
    ).context.check_overrides()


def test_arguments() -> None:
    found = parse_ros_arguments(
        [
            *("prog", "--own", "--ros-args", "-r", "a:=b", "-p", "n:x:=[1, 2]"),
            *("--params-file", "f.yaml", "--log-level", "debug"),
            *("--log-level", "planner:=WARN", "--disable-rosout-logs"),
            *("--disable-external-lib-logs", "-e", "/enclave", "c:=d", "--", "last"),
        ]
    )
    assert found.other == ["prog", "--own", "last"]
    assert [(r.match, r.replacement) for r in found.remaps] == [("a", "b"), ("c", "d")]
    assert found.parameters == [("n", "x", [1, 2]), Path("f.yaml")]
    assert found.log_levels == [
        (None, LoggingSeverity.DEBUG),
        ("planner", LoggingSeverity.WARN),
    ]
    assert (found.enable_rosout, found.enclave) == (False, "/enclave")


@pytest.mark.parametrize(
    "args",
    [
        ["--what"],
        ["-p"],
        ["-p", "x"],
        ["--log-level", "loud"],
        ["-r", "x"],
        ["stray"],
        ["-p", "a:="],
        ["-p", "a b:=1"],
        ["-e", "/a b"],
        ["--log-file-name", "a/b"],
    ],
)
def test_invalid_arguments(args: list[str]) -> None:
    with pytest.raises(InvalidValueError) as caught:
        parse_ros_arguments(["--ros-args", *args])
    assert isinstance(caught.value, RCLError)
    unknown = args[0] in ("--what", "stray")
    assert isinstance(caught.value, UnknownROSArgsError) == unknown


def test_blocks_of_the_same_node_all_count() -> None:
    text = """\
n:
  ros__parameters:
    a: 1
    deep: {x: 1}
/**: {ros__parameters: {c: 3}}
n:
  ros__parameters:
    b: 2
    a: 4
    deep: {y: 2}
"""
    assert parse_parameters(text) == [
        ("/n", {"a": 4, "deep.x": 1, "deep.y": 2, "b": 2}),
        ("/**", {"c": 3}),
    ]


def test_an_empty_file_has_no_parameters() -> None:
    assert parse_parameters("# nothing yet\n") == []


def test_a_node_name_with_spaces_is_refused() -> None:
    with pytest.raises(FileFormatError, match="node name 'a b'"):
        parse_parameters("a b: {ros__parameters: {p: 8}}")


def test_a_log_file_is_named_as_ros_2_does(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path))
    context = Context()
    context.init(["--ros-args", "--log-file-name", "mine", "--disable-stdout-logs"])
    Node("n", context=context).get_logger().info("noted")
    context.shutdown()
    (path,) = tmp_path.iterdir()
    assert path.name.startswith("mine_")
    assert path.suffix == ".log"
    assert "noted" in path.read_text()


def test_remove_ros_args() -> None:
    args = ["prog", "-a", "--ros-args", "-r", "a:=b", "--", "-b", "--ros-args", "-p"]
    assert remove_ros_args(args) == ["prog", "-a", "-b"]


def test_formatted_parameters_are_read_unchanged() -> None:
    values: dict[str, Any] = {
        "x": 2,
        "x.y": 1e-5,  # x is a value and a prefix
        "limits.max_speed": 1e16,
        "infinite": float("inf"),
        "y": True,
        "text.number": "1e5",  # a number to ROS 2, not to YAML's own rules
        "text.octal": "0o17",
        "text.switch": "on",
        "text.empty": "",
        "text.nothing": "null",
        "text.lines": "one\ntwo: ü",
        "names": ["1", "a"],
        "poses": [1.0, -2.5],
        "none": [],
    }
    text = format_parameters({"/ns/node": values})
    ((pattern, read),) = parse_parameters(text)
    assert pattern == "/ns/node"
    assert read == values
    assert {name: type(value) for name, value in read.items()} == {
        name: type(value) for name, value in values.items()
    }
