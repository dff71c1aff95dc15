"""User packages: loaded from a folder, found on the search path, or from a bag."""

from pathlib import Path

import pytest

from navette.errors import FileFormatError, InvalidNameError, UnknownNameError
from navette.msgs import (
    add_interface_path,
    copy_message,
    definition_text,
    deserialize,
    get_interface,
    interface_names,
    load_interfaces,
    packages,
    register_definition,
    serialize,
    type_hash,
)


def write(folder: Path, **files: str) -> Path:
    """Files by name with ``__`` for the dot; the suffix names the sub-folder."""
    for name, text in files.items():
        stem, kind = name.split("__")
        (folder / kind).mkdir(parents=True, exist_ok=True)
        (folder / kind / f"{stem}.{kind}").write_text(text)
    return folder


def test_load_interfaces(tmp_path: Path) -> None:
    write(
        tmp_path,
        Wheel__msg="float64 radius 0.4\nuint8 LEFT=1\n",
        Cart__msg="std_msgs/Header header\nWheel[2] wheels\nstring<=3 name\n",
        Stop__srv="bool hard\n---\nbool success\n",
        Drive__action="Cart cart\n---\nbool reached\n---\nfloat32 left\n",
    )
    names = load_interfaces("registry_cart", tmp_path)
    assert names == [
        "registry_cart/action/Drive",
        "registry_cart/msg/Cart",
        "registry_cart/msg/Wheel",
        "registry_cart/srv/Stop",
    ]
    assert interface_names("registry_cart", "msg") == ["Cart", "Wheel"]
    assert "registry_cart" in packages()
    cart = get_interface("registry_cart/msg/Cart")(name="abc")
    assert cart.wheels[1].radius == 0.4
    assert cart.wheels[0].LEFT == 1
    assert deserialize(serialize(cart), type(cart)) == cart == copy_message(cart)
    assert get_interface("registry_cart/srv/Stop").Request(hard=True).hard
    goal = get_interface("registry_cart/action/Drive").Goal(cart=cart)
    assert goal.cart.name == "abc"
    assert type_hash("registry_cart/action/Drive").startswith("RIHS01_")
    # The same files again change nothing.
    assert load_interfaces("registry_cart", tmp_path) == names
    assert get_interface("registry_cart/msg/Cart") is type(cart)


@pytest.mark.parametrize(
    ("files", "text"),
    [
        ({"Foo__msg": "int32 x\nint33 y\n"}, r"Foo\.msg:2: unknown type 'int33'"),
        ({"Foo__msg": "Bar bar\n"}, r"Foo\.msg: field 'bar': unknown interface"),
        ({"Foo__msg": "nowhere_msgs/Bar bar\n"}, r"'bar': unknown interface package"),
        ({"Foo__msg": "Foo foo\n"}, r"Foo\.msg: field 'foo': .* contains itself"),
        ({"Foo__msg": "Bar b\n", "Bar__msg": "Foo[] f\n"}, r"\.msg: .*contains itself"),
        ({"foo__msg": "int32 x\n"}, r"foo\.msg: the file name is not a CamelCase"),
        ({"Foo__srv": "int32 x\n"}, r"Foo\.srv: 1 parts"),
        ({}, r"no interface definitions"),
    ],
)
def test_broken_packages(tmp_path: Path, files: dict[str, str], text: str) -> None:
    write(tmp_path, **files)
    with pytest.raises(FileFormatError, match=text):
        load_interfaces("registry_broken", tmp_path)
    assert "registry_broken" not in packages()
    with pytest.raises(UnknownNameError):
        get_interface("registry_broken/msg/Foo")


def test_a_definition_that_is_not_utf8(tmp_path: Path) -> None:
    write(tmp_path, Foo__msg="")
    (tmp_path / "msg" / "Foo.msg").write_bytes(b"int32 x # \xff\n")
    with pytest.raises(FileFormatError, match=r"Foo\.msg: not UTF-8"):
        load_interfaces("registry_binary", tmp_path)


def test_a_loaded_type_cannot_change(tmp_path: Path) -> None:
    write(tmp_path, Foo__msg="int32 x\n")
    load_interfaces("registry_fixed", tmp_path)
    write(tmp_path, Foo__msg="int32 y\n")
    with pytest.raises(FileFormatError, match="registered with another definition"):
        load_interfaces("registry_fixed", tmp_path)
    assert interface_names("registry_fixed", "msg") == ["Foo"]


@pytest.mark.parametrize("package", ["Cart", "1cart", "a__b", "a-b"])
def test_package_names(tmp_path: Path, package: str) -> None:
    write(tmp_path, Foo__msg="int32 x\n")
    with pytest.raises(InvalidNameError, match="package"):
        load_interfaces(package, tmp_path)


def test_packages_are_found_on_the_path(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write(tmp_path / "by_call" / "registry_near", Foo__msg="registry_far/Bar bar\n")
    write(tmp_path / "by_variable" / "registry_far", Bar__msg="int32 x 3\n")
    monkeypatch.setenv("NAVETTE_INTERFACE_PATH", str(tmp_path / "by_variable"))
    monkeypatch.setattr("navette.msgs.registry._search_path", [])
    assert "registry_near" not in packages()
    add_interface_path(tmp_path / "by_call")
    assert {"registry_near", "registry_far"} <= set(packages())
    assert get_interface("registry_near/Foo")().bar.x == 3
    with pytest.raises(FileFormatError, match="no such folder"):
        add_interface_path(tmp_path / "nowhere")


def test_types_from_their_text() -> None:
    text = "registry_bag/Inner[] inner\nstd_msgs/Header header\n"
    text += "=" * 80 + "\nMSG: registry_bag/Inner\nfloat32 x\n"
    register_definition("registry_bag/msg/Outer", text)
    outer = get_interface("registry_bag/msg/Outer")
    inner = get_interface("registry_bag/msg/Inner")
    assert outer(inner=[inner(x=1)]).inner[0].x == 1.0
    # definition_text can be loaded again; a registered type is kept.
    register_definition("registry_bag/Outer", definition_text("registry_bag/Outer"))
    for name in ("nav_msgs/msg/Odometry", "shape_msgs/msg/SolidPrimitive"):
        register_definition(name, definition_text(name))
    # An older release lacked a constant.
    register_definition("std_msgs/msg/Bool", "uint8 NEW=1\nbool data\n")
    assert not hasattr(get_interface("std_msgs/msg/Bool"), "NEW")


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("int32 x y z\n", r"definition of .*:1: "),
        ("registry_lost/Inner inner\n", "unknown interface package 'registry_lost'"),
        ("=" * 80 + "\nint32 x\n", "expected 'MSG: package/Name'"),
        (
            "=" * 80 + "\nMSG: std_msgs/String\nint32 x\n",
            "registered with other fields",
        ),
    ],
)
def test_broken_texts(text: str, reason: str) -> None:
    with pytest.raises(FileFormatError, match=reason):
        register_definition("registry_text/msg/Foo", text)
    with pytest.raises(UnknownNameError):
        get_interface("registry_text/msg/Foo")
