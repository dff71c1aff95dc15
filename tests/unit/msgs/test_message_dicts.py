"""Messages as plain dicts and back."""

import json

import numpy as np
import pytest

from navette.errors import MessageError
from navette.msgs import from_dict, to_dict
from navette.msgs.diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from navette.msgs.geometry_msgs.msg import PoseStamped, Twist, Vector3
from navette.msgs.nav_msgs.msg import Path
from navette.msgs.sensor_msgs.msg import CompressedImage, LaserScan


def test_to_dict_converts_nested_messages() -> None:
    message = DiagnosticArray(
        status=[DiagnosticStatus(level=b"\x01", values=[KeyValue(key="a", value="b")])]
    )
    plain = to_dict(message)
    assert plain["status"][0]["level"] == 1
    assert plain["status"][0]["values"] == [{"key": "a", "value": "b"}]
    assert from_dict(DiagnosticArray, json.loads(json.dumps(plain))) == message


def test_arrays_become_lists() -> None:
    assert to_dict(CompressedImage(data=b"\x01\x02"))["data"] == [1, 2]
    assert to_dict(LaserScan(ranges=np.arange(2)))["ranges"] == [0.0, 1.0]


def test_from_dict_keeps_the_defaults_of_other_fields() -> None:
    pose = from_dict(PoseStamped, {"pose": {"position": {"x": 2}}})
    assert pose.pose.position.x == 2.0
    assert pose.pose.orientation.w == 1.0
    path = from_dict(Path, {"poses": [{"header": {"frame_id": "map"}}, PoseStamped()]})
    assert [each.header.frame_id for each in path.poses] == ["map", ""]
    assert from_dict(Twist, {"linear": Vector3(x=1.0)}).linear.x == 1.0


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ({"lin": {}}, "Twist has no field 'lin'; its fields: linear, angular"),
        ({"linear": {"w": 1}}, "Vector3 has no field 'w'"),
        ({"linear": 3}, "Twist.linear: 3 is int"),
        ({"linear": {"x": "fast"}}, "Vector3.x: 'fast' is str"),
        ([1, 2], "expected a dict of fields"),
        ({3: 1}, "expected a dict of fields"),
    ],
)
def test_wrong_dicts_are_refused(values: object, text: str) -> None:
    with pytest.raises(MessageError, match=text):
        from_dict(Twist, values)  # type: ignore[arg-type]
