"""Programs of tf2_ros: command lines of static_transform_publisher."""

import math

import pytest

from navette.cli.tf2_programs import read_static_transform


@pytest.mark.parametrize(
    "words",
    [
        ["--x", "1", "--yaw", "1.5707963", "--frame-id", "a", "--child-frame-id", "b"],
        ["1", "0", "0", "1.5707963", "0", "0", "a", "b"],
        ["1", "0", "0", "0", "0", "0.70710678", "0.70710678", "a", "b"],
    ],
)
def test_forms_of_the_command_line(words: list[str]) -> None:
    found = read_static_transform(words)
    assert (found.header.frame_id, found.child_frame_id) == ("a", "b")
    assert found.transform.translation.x == 1.0
    turn = found.transform.rotation
    assert (turn.z, turn.w) == pytest.approx((math.sqrt(0.5), math.sqrt(0.5)), abs=1e-6)


def test_negative_numbers_of_the_old_form() -> None:
    found = read_static_transform(["-1", "0", "-0.5", "0", "0", "0", "a", "b"])
    assert found.transform.translation.z == -0.5
    assert found.transform.rotation.w == 1.0


def test_angles_and_quaternion_exclude_each_other(
    capsys: pytest.CaptureFixture[str],
) -> None:
    words = ["--yaw", "1", "--qw", "1", "--frame-id", "a", "--child-frame-id", "b"]
    with pytest.raises(SystemExit):
        read_static_transform(words)
    assert "not both" in capsys.readouterr().err
