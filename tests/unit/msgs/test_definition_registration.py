"""Registration of types at run time: limits, conflicts, ROS 1 definitions."""

from contextlib import suppress
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from navette.errors import FileFormatError, NavetteError
from navette.msgs import (
    definition_text,
    deserialize,
    get_interface,
    register_definition,
    ros1_definition,
    serialize,
    type_hash,
    type_name,
)

LINE = "=" * 80


def test_an_unknown_type_gets_a_class() -> None:
    text = (
        f"registration_a/Wheel[] wheels\n{LINE}\nMSG: registration_a/Wheel\nfloat64 r\n"
    )
    cart: Any = register_definition("registration_a/msg/Cart", text)
    wheel: Any = get_interface("registration_a/msg/Wheel")
    sent = serialize(cart(wheels=[wheel(r=0.5)]))
    assert deserialize(sent, cart).wheels[0].r == 0.5
    assert register_definition("registration_a/Cart", text) is cart


def test_services_and_actions() -> None:
    add: Any = register_definition(
        "registration_s/srv/Add", "int64 a\nint64 b\n---\nint64 sum\n"
    )
    assert add.Request(a=1).b == 0
    fly: Any = register_definition(
        "registration_s/action/Fly", "int32 h\n---\nbool ok\n---\nint32 at\n"
    )
    assert fly.Impl.SendGoalService.Request().goal.h == 0
    event: Any = register_definition(
        "registration_s/srv/Other_Event", "service_msgs/ServiceEventInfo info\n"
    )
    assert type_name(event) == "registration_s/srv/Other_Event"


def test_a_known_type_is_kept() -> None:
    name = "nav_msgs/msg/Odometry"
    assert register_definition(name, definition_text(name)) is get_interface(name)


def test_another_definition_of_a_known_name() -> None:
    old = f"std_msgs/Header header\ngeometry_msgs/Point p\n{LINE}\n"
    old += "MSG: geometry_msgs/Point\nfloat32 x\nfloat32 y\n"
    with pytest.raises(
        FileFormatError, match="geometry_msgs/msg/Point is registered with"
    ):
        register_definition("registration_p/msg/Mark", old)
    mark: Any = register_definition("registration_p/msg/Mark", old, private=True)
    assert type_name(mark).startswith("registration_p__")
    assert type_name(mark().p).startswith("geometry_msgs__")
    assert type_name(mark().header) == "std_msgs/msg/Header"
    assert not hasattr(mark().p, "z")
    assert mark is register_definition("registration_p/msg/Mark", old, private=True)
    # The public name is still free.
    new: Any = register_definition("registration_p/msg/Mark", "geometry_msgs/Point p\n")
    assert new().p.z == 0.0
    assert type_hash("registration_p/msg/Mark").startswith("RIHS01_")


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("x" * (1 << 21), "characters; at most"),
        ("int32 x\n" * 5000, "more than 4096 lines"),
        (f"int32 x\n{LINE}\nMSG: a_b/C\nint8 x\n" * 600, "types; at most 500"),
        ("uint8[99999999999] x\n", "bytes of arrays; at most"),
        (f"uint8[{'9' * 5000}] x\n", "digits"),
        ("registration_b/Big b\n", "contains itself"),
        (f"int32 x\n{LINE}\nMSG: ../x/msg/Y\nint8 x\n", "expected 'package/msg/Name'"),
        (f"int32 x\n{LINE}\nMSG: A/msg/Y\nint8 x\n", "not a type name"),
        (
            f"int32 x\n{LINE}\nMSG: a_b/C\nint8 x\n{LINE}\nMSG: a_b/C\nint8 y\n",
            "two different definitions",
        ),
    ],
)
def test_hostile_text_is_refused(text: str, reason: str) -> None:
    with pytest.raises(NavetteError, match=reason):
        register_definition("registration_b/msg/Big", text)


def test_exponentially_large_types_are_refused() -> None:
    """Each type contains the next twice: 2**30 fields in few lines."""
    text = "registration_x/T1 a\n"
    for number in range(1, 30):
        text += f"{LINE}\nMSG: registration_x/T{number}\n"
        text += f"registration_x/T{number + 1}[2] a\n"
    text += f"{LINE}\nMSG: registration_x/T30\nint8 a\n"
    with pytest.raises(FileFormatError, match="fields and"):
        register_definition("registration_x/msg/T0", text)
    with pytest.raises(FileFormatError, match="types deep"):
        register_definition(
            "registration_x/msg/D0",
            "registration_x/D1 a\n"
            + "".join(
                f"{LINE}\nMSG: registration_x/D{n}\nregistration_x/D{n + 1} a\n"
                for n in range(1, 60)
            ),
        )


@given(st.text(alphabet="=\nMSG: ab/C[]<019#\"'\\-intf", max_size=200))
def test_any_text_is_a_type_or_a_file_format_error(text: str) -> None:
    for read in (
        lambda: register_definition("registration_f/msg/F", text, private=True),
        lambda: ros1_definition("registration_f/F", text),
    ):
        with suppress(NavetteError):
            read()


CAMERA = f"""
# A ROS 1 text.
Header header
uint32 height
float64[]  D   # distortion
float64[9] K
time when
duration[2] lasted
char c
byte b
Region roi
int32 MAX=5 # five
string HASH=a # is part of it
int32 lower_case=1
tf/tfMessage frames
{LINE}
MSG: std_msgs/Header
uint32 seq
time stamp
string frame_id
{LINE}
MSG: registration_r/Region
bool do_it
uint8 aB
uint8 a_b
{LINE}
MSG: tf/tfMessage
geometry_msgs/TransformStamped[] transforms
"""


def test_ros1_definitions_are_converted() -> None:
    name, text = ros1_definition("registration_r/camera_like", CAMERA)
    assert name == "registration_r/msg/CameraLike"
    message: Any = register_definition(name, text)()
    assert list(message.get_fields_and_field_types()) == (
        "header height d k when lasted c b roi frames".split()
    )
    assert list(message.roi.get_fields_and_field_types()) == ["do_it", "a_b", "a_b2"]
    assert (message.MAX, message.HASH) == (5, "a # is part of it")
    assert message.when.sec == message.lasted[1].nanosec == 0
    assert message.header.stamp.sec == 0
    assert not hasattr(message, "lower_case")
    assert type_name(message.frames) == "tf2_msgs/msg/TFMessage"


@pytest.mark.parametrize("text", ["int32\n", "a-b c\n", "/ x\n", "a/b/c x\n"])
def test_broken_ros1_text(text: str) -> None:
    with pytest.raises(FileFormatError, match="ROS 1 definition of"):
        ros1_definition("registration_r/Broken", text)
