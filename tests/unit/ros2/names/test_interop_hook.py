"""What ROS 2's module names mean while the import hook is installed."""

import subprocess
import sys
import textwrap
import threading
from importlib import import_module  # noqa: TID251 - the names are the subject
from pathlib import Path
from types import ModuleType

import pytest

from navette import runtime
from navette.msgs import add_interface_path
from navette.msgs.std_msgs.msg import String
from navette.ros2 import names as interop
from navette.ros2.names.hook import PROVIDED, AliasLoader, RealRosError


def test_importing_navette_installs_nothing() -> None:
    code = "import navette, navette.ros2.names, sys; import rclpy"
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=False
    )
    assert "No module named 'rclpy'" in done.stderr


def test_classes_are_navettes_own() -> None:
    import rclpy
    import rclpy.node
    from rclpy.qos import QoSProfile
    from std_msgs.msg import String as Ros2String

    assert rclpy.init is runtime.init
    assert rclpy.node.Node is runtime.Node
    assert QoSProfile is runtime.QoSProfile
    assert Ros2String is String


def test_submodules_are_there_after_a_plain_import() -> None:
    import rclpy

    assert rclpy.time.Time is runtime.Time


@pytest.mark.parametrize("package", sorted(PROVIDED))
def test_every_module_gives_what_it_lists(package: str) -> None:
    waiting = [package]
    while waiting:
        module = import_module(waiting.pop())
        for name in module.__loader__.contents():
            value = getattr(module, name)
            if getattr(value, "__name__", "") == f"{module.__name__}.{name}":
                waiting.append(value.__name__)


@pytest.mark.parametrize(
    ("statement", "said"),
    [
        ("import rclpy.wormhole", r"no rclpy\.wormhole; rclpy has .*qos"),
        ("from rclpy import wormhole", r"no rclpy\.wormhole; rclpy has "),
        ("from rclpy.qos import QoS", r"no rclpy\.qos\.QoS; .* has .*QoSProfile"),
        ("from std_msgs.msg import Str", r"no std_msgs\.msg\.Str; .* String"),
        ("import std_msgs.srv", r"no std_msgs\.srv; std_msgs has msg"),
    ],
)
def test_a_missing_name_is_an_import_error_that_says_what_exists(
    statement: str, said: str
) -> None:
    with pytest.raises(ImportError, match=said):
        exec(statement)


def test_a_missing_attribute_says_what_exists() -> None:
    import rclpy.qos
    import std_msgs.msg

    with pytest.raises(AttributeError, match=r"no rclpy\.qos\.QoS; .*QoSProfile"):
        _ = rclpy.qos.QoS
    with pytest.raises(AttributeError, match=r"it has .*String"):
        _ = std_msgs.msg.Str
    assert not hasattr(rclpy.qos, "QoS")


def test_what_programs_use_of_rclpys_inside() -> None:
    from rclpy._rclpy_pybind11 import InvalidHandle, RCLError
    from rclpy.impl.implementation_singleton import rclpy_implementation

    from navette.runtime import exceptions
    from navette.runtime.handles import PollSet

    assert RCLError is rclpy_implementation.RCLError is exceptions.RCLError
    assert InvalidHandle is exceptions.InvalidHandle
    assert rclpy_implementation.WaitSet is PollSet


def test_threads_that_import_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    plain, loading = AliasLoader.exec_module, threading.Event()

    def slow(self: AliasLoader, module: ModuleType) -> None:
        if self.name == "rclpy":  # it is listed now, and empty
            loading.set()
            other.join(0.05)
        plain(self, module)

    found: list[object] = []
    monkeypatch.setattr(AliasLoader, "exec_module", slow)
    other = threading.Thread(
        target=lambda: loading.wait() and found.append(import_module("rclpy.node"))
    )
    other.start()
    import_module("rclpy")
    other.join()
    assert found[0].Node is runtime.Node


def test_services_and_actions() -> None:
    from example_interfaces.action import Fibonacci
    from example_interfaces.srv import AddTwoInts

    assert AddTwoInts.Request(a=1).a == 1
    assert list(Fibonacci.Goal(order=3).get_fields_and_field_types()) == ["order"]


def test_packages_on_the_interface_path(tmp_path: Path) -> None:
    folder = tmp_path / "hook_msgs" / "msg"
    folder.mkdir(parents=True)
    (folder / "Speed.msg").write_text("float64 mps\n")
    add_interface_path(tmp_path)

    from hook_msgs.msg import Speed

    assert Speed(mps=1.5).mps == 1.5


def test_a_python_package_keeps_its_name_and_gets_its_interfaces(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    package = tmp_path / "mixed_robot"
    (package / "msg").mkdir(parents=True)
    (package / "msg" / "Load.msg").write_text("int32 percent\n")
    (package / "__init__.py").write_text("WHEELS = 4\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    add_interface_path(tmp_path)

    import mixed_robot
    from mixed_robot.msg import Load

    assert mixed_robot.WHEELS == 4
    assert Load(percent=5).percent == 5


def test_a_folder_named_like_a_module_does_not_hide_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "rclpy").mkdir()
    monkeypatch.syspath_prepend(str(tmp_path))

    import rclpy

    assert rclpy.ok is runtime.ok


def test_a_module_beside_the_program_goes_first(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "tf2_ros.py").write_text("MINE = True\n")
    monkeypatch.syspath_prepend(str(tmp_path))

    import tf2_ros

    assert tf2_ros.MINE


def test_uninstall_forgets_the_names() -> None:
    import rclpy  # noqa: F401

    interop.uninstall()
    with pytest.raises(ModuleNotFoundError, match="No module named 'rclpy'"):
        import_module("rclpy")


class TestRealRos:
    @pytest.fixture(autouse=True)
    def real_rclpy(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        interop.uninstall()
        (tmp_path / "rclpy").mkdir()
        (tmp_path / "rclpy" / "__init__.py").write_text("REAL = True\n")
        monkeypatch.syspath_prepend(str(tmp_path))
        monkeypatch.setattr(sys, "path", ["", *sys.path])

    def test_is_not_hidden_unasked(self, tmp_path: Path) -> None:
        assert interop.installed_rclpy() == tmp_path / "rclpy"
        with pytest.raises(RealRosError, match="rclpy is installed at"):
            interop.install()
        assert not interop.is_installed()

    def test_is_hidden_on_request(self) -> None:
        interop.install(instead_of_ros=True)

        import rclpy

        assert rclpy.init is runtime.init

    def test_is_not_replaced_once_imported(
        self, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setitem(sys.modules, "rclpy", ModuleType("rclpy"))
        with pytest.raises(RealRosError, match="imported already"):
            interop.install(instead_of_ros=True)


@pytest.mark.slow
def test_the_pytest_plugin_installs_it(tmp_path: Path) -> None:
    (tmp_path / "test_talker.py").write_text(
        textwrap.dedent("""
            import rclpy

            def test_it():
                assert rclpy.init.__module__ == "navette.runtime.api"
        """)
    )
    done = subprocess.run(
        [
            *(sys.executable, "-m", "pytest", "-q"),
            *("-p", "navette.ros2.names.pytest_plugin"),
        ],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout
