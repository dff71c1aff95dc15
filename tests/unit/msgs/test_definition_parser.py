"""Parser of definition files: values and errors."""

import pytest

from navette.errors import FileFormatError
from navette.msgs.interface import Constant, Field, FieldType
from navette.msgs.parser import parse_action, parse_message, parse_service


def only_field(line: str) -> Field:
    (field,) = parse_message("pkg/msg/Foo", line, "Foo.msg").fields
    return field


@pytest.mark.parametrize(
    ("text", "type_"),
    [
        ("float64", FieldType("float64")),
        ("char", FieldType("char")),
        ("byte[]", FieldType("byte", "sequence")),
        ("uint8[16]", FieldType("uint8", "array", 16)),
        ("int32[<=5]", FieldType("int32", "sequence", 5)),
        ("string<=10", FieldType("string", string_bound=10)),
        ("string<=10[<=5]", FieldType("string", "sequence", 5, 10)),
        ("wstring[2]", FieldType("wstring", "array", 2)),
        ("Bar", FieldType("pkg/msg/Bar")),
        ("std_msgs/Header", FieldType("std_msgs/msg/Header")),
        ("std_msgs/msg/Header[]", FieldType("std_msgs/msg/Header", "sequence")),
    ],
)
def test_types(text: str, type_: FieldType) -> None:
    assert only_field(f"{text} x").type == type_


def test_types_print_as_they_are_written() -> None:
    for text in ("float64[36]", "string<=10[<=5]", "geometry_msgs/Point[]", "wstring"):
        assert str(only_field(f"{text} x").type) == text


@pytest.mark.parametrize(
    ("line", "default"),
    [
        ("int32 x 5", 5),
        ("int32 x -0x10", -16),
        ("uint8 x 007", 7),
        ("float64 x 1", 1.0),
        ("float32 x -1.5e3", -1500.0),
        ("bool x true", True),
        ("bool x 0", False),
        ("byte x 7", b"\x07"),
        ('string x "a # b"  # a comment', "a # b"),
        ("string x 'it'", "it"),
        ("string x bare words", "bare words"),
        ('string x "line\\nfeed"', "line\nfeed"),
        ("int8[3] x [1, 2, 3]", [1, 2, 3]),
        ("float64[] x []", []),
        ('string[] x ["a, b", "c"]', ["a, b", "c"]),
    ],
)
def test_defaults(line: str, default: object) -> None:
    assert only_field(line).default == default


@pytest.mark.parametrize(
    ("line", "constant"),
    [
        ("uint8 LOW=1", Constant("LOW", "uint8", 1)),
        ("int32 A_B = -123 # why", Constant("A_B", "int32", -123)),
        ("float32 G=9.81", Constant("G", "float32", 9.81)),
        ('string NAME="x=y"', Constant("NAME", "string", "x=y")),
        ("string EMPTY=", Constant("EMPTY", "string", "")),
        ("byte OK=0", Constant("OK", "byte", b"\0")),
        ("bool YES=True", Constant("YES", "bool", True)),
    ],
)
def test_constants(line: str, constant: Constant) -> None:
    assert parse_message("pkg/msg/Foo", line).constants == (constant,)


def test_comments_and_blank_lines_are_ignored() -> None:
    text = "# it's a comment\n\n  \t\nint32 x # the robot's\n#int32 y\n"
    assert [each.name for each in parse_message("p/msg/F", text).fields] == ["x"]


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("int32", "type name"),
        ("int32 X", "lower-case"),
        ("int32 x_", "lower-case"),
        ("int32 a__b", "lower-case"),
        ("int33 x", "unknown type 'int33'"),
        ("time x", "unknown type 'time'"),
        ("int32[0] x", "is at least 1"),
        ("int32[<=] x", "is at least 1"),
        ("int32<=5 x", "only strings"),
        ("int32[-1] x", "base[N]"),
        ("int8 x 128", "'128' is not of type int8"),
        ("uint8 x -1", "is not of type uint8"),
        ("float64 x one", "is not of type float64"),
        ("bool x 2", "is not of type bool"),
        ("string<=2 x abc", "is not of type string<=2"),
        ("int8[2] x [1]", "1 values"),
        ("int8[<=2] x [1, 2, 3]", "3 values"),
        ("int8[2] x 1", "expected [value"),
        ("std_msgs/Header x 1", "cannot have a default"),
        ("int8 low=1", "upper case"),
        ("int8 LOW=", "no value"),
        ("int8[2] LOW=1", "not a primitive"),
        ("std_msgs/Header LOW=1", "not a primitive"),
    ],
)
def test_mistakes_name_file_and_line(line: str, reason: str) -> None:
    with pytest.raises(FileFormatError) as caught:
        parse_message("pkg/msg/Foo", f"int8 first\n{line}\n", "msg/Foo.msg")
    assert str(caught.value).startswith("msg/Foo.msg:2: ")
    assert reason in str(caught.value)
    assert caught.value.line == 2


def test_an_open_quote_is_text() -> None:
    assert only_field('string x "half # comment').default == '"half'


def test_a_name_used_twice_is_refused() -> None:
    with pytest.raises(FileFormatError, match=r"Foo\.msg:2: 'x' is defined twice"):
        parse_message("pkg/msg/Foo", "int8 x\nint8 x\n", "Foo.msg")


def test_service_has_request_response_and_event() -> None:
    spec = parse_service("pkg/srv/Add", "int64 a\nint64 b\n---\nint64 sum\n")
    assert [each.name for each in spec.request.fields] == ["a", "b"]
    assert spec.response.name == "pkg/srv/Add_Response"
    assert [str(each.type) for each in spec.event.fields] == [
        "service_msgs/ServiceEventInfo",
        "pkg/Add_Request[<=1]",
        "pkg/Add_Response[<=1]",
    ]


def test_action_becomes_two_services_and_a_feedback_message() -> None:
    spec = parse_action("pkg/action/Go", "int8 a\n---\nint8 b\n---\nint8 c\n")
    goal_request = spec.send_goal.request
    assert goal_request.name == "pkg/action/Go_SendGoal_Request"
    assert [each.name for each in goal_request.fields] == ["goal_id", "goal"]
    response = spec.get_result.response
    assert [each.name for each in response.fields] == ["status", "result"]
    assert spec.feedback_message.fields[1].type.base == "pkg/action/Go_Feedback"


@pytest.mark.parametrize("text", ["int8 a\n", "---\n---\n"])
def test_wrong_number_of_parts(text: str) -> None:
    with pytest.raises(FileFormatError, match=r"a \.srv file has 2"):
        parse_service("pkg/srv/Foo", text, "Foo.srv")


def test_parts_may_be_empty() -> None:
    spec = parse_service("pkg/srv/Foo", "---")
    assert spec.request.fields == spec.response.fields == ()
    assert spec.request.wire_fields[0].name == "structure_needs_at_least_one_member"
