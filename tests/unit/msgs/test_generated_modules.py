"""Generated modules and stubs: contents, import cost, types."""

import subprocess
import sys
from pathlib import Path

import pytest

from navette.msgs import generate

SNIPPET = """
from array import array
import numpy as np
from numpy.typing import NDArray
from navette.msgs import copy_message, deserialize, get_interface, serialize
from navette.msgs.example_interfaces.action import Fibonacci
from navette.msgs.geometry_msgs.msg import Point, PoseWithCovariance, Twist
from navette.msgs.rcl_interfaces.msg import ParameterValue
from navette.msgs.sensor_msgs.msg import LaserScan
from navette.msgs.std_srvs.srv import SetBool
from navette.msgs.visualization_msgs.msg import Marker

twist = Twist()
twist.linear.x = 1.0
twist = copy_message(deserialize(serialize(twist), Twist))
scan = LaserScan(ranges=[1, 2])
scan.ranges = [3.0]
scan.ranges = np.zeros(3)
scan.ranges.append(1.0)
ranges: array[float] = scan.ranges
view: NDArray[np.float32] = np.asarray(scan.ranges)
covariance: NDArray[np.float64] = PoseWithCovariance().covariance
values: list[bool] = ParameterValue(bool_array_value=[True]).bool_array_value
octets: list[bytes] = ParameterValue().byte_array_value
marker = Marker(type=Marker.ARROW, points=[Point(x=1)])
ok: bool = SetBool.Response(success=True).success
goal = Fibonacci.Goal(order=3)
send = Fibonacci.Impl.SendGoalService.Request(goal=goal)
"""
MISTAKES = """
from navette.msgs.geometry_msgs.msg import Twist
Twist().linear = 3
Twist().lin
Twist(lin=3)
from navette.msgs.geometry_msgs.msg import Twits
"""


def test_committed_modules_are_up_to_date() -> None:
    for path, text in generate.generated_files().items():
        if path.suffix == ".py":
            committed = (generate.ROOT / path).read_text("utf-8")
            assert committed == text, "run: python -m navette.msgs.generate"


def test_only_changed_files_are_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(generate, "ROOT", tmp_path)
    assert Path("geometry_msgs", "msg.pyi") in generate.write_files()
    (tmp_path / "std_msgs" / "msg.pyi").write_text("outdated")
    assert generate.write_files() == [Path("std_msgs", "msg.pyi")]


def test_names_hashes_and_the_generator_need_no_numpy() -> None:
    code = (
        "import sys, navette.msgs.generate, navette.msgs.std_msgs.msg\n"
        "navette.msgs.interface_names('std_msgs', 'msg')\n"
        "navette.msgs.type_hash('std_msgs/msg/String')\n"
        "assert 'numpy' not in sys.modules\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def mypy(path: Path, code: str) -> str:
    path.write_text(code)
    command = [sys.executable, "-m", "mypy", "--strict", "--no-error-summary"]
    cache = f"--cache-dir={path.parent}"
    done = subprocess.run(
        [*command, cache, str(path)], capture_output=True, text=True, check=False
    )
    return done.stdout + done.stderr


@pytest.mark.long
def test_stubs_satisfy_a_users_strict_mypy(tmp_path: Path) -> None:
    stub = generate.ROOT / "std_msgs" / "msg.pyi"
    assert stub.is_file(), "run: python -m navette.msgs.generate"
    assert mypy(tmp_path / "good.py", SNIPPET) == ""
    errors = mypy(tmp_path / "bad.py", MISTAKES)
    for line in range(3, 7):
        assert f"bad.py:{line}: error" in errors
