"""The import hook: which code ROS 2's module names load while it is installed."""

import subprocess
import sys
import textwrap
import threading
from collections.abc import Iterator, Sequence
from importlib import (
    import_module,  # noqa: TID251 - the names are the subject
    invalidate_caches,
)
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec
from importlib.util import spec_from_file_location
from pathlib import Path
from types import ModuleType

import pytest

from navette import runtime
from navette.msgs import add_interface_path
from navette.msgs.std_msgs.msg import String
from navette.ros2 import names
from navette.ros2.names.hook import PROVIDED, RealRosError
from navette.ros2.names.loaders import RclpyLoader
from navette.ros2.names.rclpy_names import rclpy_modules
from navette.ros2.names.stubs import stub_texts


def test_importing_navette_installs_nothing() -> None:
    code = "import navette, navette.ros2.names, sys; import rclpy"
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=False
    )
    assert "No module named 'rclpy'" in done.stderr


def test_the_classes_are_navettes() -> None:
    import rclpy
    import rclpy.node
    from rclpy.qos import QoSProfile
    from std_msgs.msg import String as Ros2String

    assert rclpy.init is runtime.init
    assert rclpy.node.Node is runtime.Node
    assert QoSProfile is runtime.QoSProfile
    assert Ros2String is String


def test_submodules_are_available_after_importing_only_rclpy() -> None:
    import rclpy

    assert rclpy.time.Time is runtime.Time


@pytest.mark.parametrize("module", sorted(rclpy_modules()))
def test_every_name_of_the_table_exists(module: str) -> None:
    imported = import_module(module)
    for name, place in rclpy_modules()[module].items():
        if place.module.startswith("navette"):
            defined = getattr(import_module(place.module), place.attribute)
            assert getattr(imported, name) is defined


@pytest.mark.parametrize(
    "module",
    [
        "rclpy",
        "rclpy.action.server",
        "rclpy.experimental",
        "rclpy.impl.rcutils_logger",
        "rclpy.lifecycle.node",
        "rclpy.qos_event",
    ],
)
def test_a_star_import_takes_the_names_of_the_table(module: str) -> None:
    namespace: dict[str, object] = {}
    exec(f"from {module} import *", namespace)
    assert namespace.keys() - {"__builtins__"} == rclpy_modules()[module].keys()
    assert import_module(module).__all__ == sorted(rclpy_modules()[module])


def test_modules_list_their_names_and_submodules() -> None:
    import rclpy

    assert {"Node", "action", "qos", "spin"} <= set(dir(rclpy))
    assert "_rclpy_pybind11" not in dir(rclpy)


def test_names_with_another_meaning_in_one_module() -> None:
    import rclpy.lifecycle
    import rclpy.logging

    assert rclpy.lifecycle.Node is runtime.LifecycleNode
    assert rclpy.logging.shutdown is not rclpy.shutdown


def test_stubs_import_every_name_of_the_table() -> None:
    texts = {path.as_posix(): text for path, text in stub_texts().items()}
    assert len(texts) == len(rclpy_modules())
    assert "from navette.runtime import Node as Node\n" in texts["rclpy/node.pyi"]
    assert "rclpy/action/__init__.pyi" in texts


@pytest.mark.parametrize("package", sorted(PROVIDED))
def test_every_listed_name_of_a_package_exists(package: str) -> None:
    waiting = [package]
    while waiting:
        module = import_module(waiting.pop())
        for name in module.__loader__.contents():
            value = getattr(module, name)
            if getattr(value, "__name__", "") == f"{module.__name__}.{name}":
                waiting.append(value.__name__)


@pytest.mark.parametrize(
    ("statement", "message"),
    [
        ("import rclpy.wormhole", r"no rclpy\.wormhole; rclpy has .*qos"),
        ("from rclpy import wormhole", r"no rclpy\.wormhole; rclpy has "),
        ("from rclpy.qos import QoS", r"no rclpy\.qos\.QoS; .* has .*QoSProfile"),
        ("from std_msgs.msg import Str", r"no std_msgs\.msg\.Str; .* String"),
        ("import std_msgs.srv", r"no std_msgs\.srv; std_msgs has msg"),
    ],
)
def test_the_import_error_of_a_missing_name_lists_existing_names(
    statement: str, message: str
) -> None:
    with pytest.raises(ImportError, match=message):
        exec(statement)


def test_the_error_of_a_missing_attribute_lists_existing_names() -> None:
    import rclpy.qos
    import std_msgs.msg

    with pytest.raises(AttributeError, match=r"no rclpy\.qos\.QoS; .*QoSProfile"):
        _ = rclpy.qos.QoS
    with pytest.raises(AttributeError, match=r"it has .*String"):
        _ = std_msgs.msg.Str
    assert not hasattr(rclpy.qos, "QoS")


def test_internal_names_of_rclpy_that_programs_use() -> None:
    from rclpy._rclpy_pybind11 import InvalidHandle, RCLError
    from rclpy.impl.implementation_singleton import rclpy_implementation

    from navette.runtime import exceptions
    from navette.runtime.poll_set import PollSet

    assert RCLError is rclpy_implementation.RCLError is exceptions.RCLError
    assert InvalidHandle is exceptions.InvalidHandle
    assert rclpy_implementation.WaitSet is PollSet


def test_two_threads_import_at_the_same_time(monkeypatch: pytest.MonkeyPatch) -> None:
    plain, loading = RclpyLoader.exec_module, threading.Event()

    def slow(self: RclpyLoader, module: ModuleType) -> None:
        if self.name == "rclpy":  # sys.modules has it now, without contents
            loading.set()
            other.join(0.05)
        plain(self, module)

    found: list[object] = []
    monkeypatch.setattr(RclpyLoader, "exec_module", slow)
    other = threading.Thread(
        target=lambda: loading.wait() and found.append(import_module("rclpy.node"))
    )
    other.start()
    import_module("rclpy")
    other.join()
    assert found[0].Node is runtime.Node


@pytest.mark.parametrize(
    ("module", "name"),
    [
        ("laser_geometry.laser_geometry", "LaserProjection"),
        ("tf2_geometry_msgs.tf2_geometry_msgs", "do_transform_pose"),
        ("tf2_sensor_msgs.tf2_sensor_msgs", "do_transform_cloud"),
        ("tf2_ros.buffer", "Buffer"),
        ("tf2_ros.buffer_interface", "TransformRegistration"),
        ("tf2_ros.static_transform_broadcaster", "StaticTransformBroadcaster"),
        ("tf2_ros.transform_broadcaster", "TransformBroadcaster"),
        ("tf2_ros.transform_listener", "TransformListener"),
    ],
)
def test_modules_of_packages_that_are_one_file_in_navette(
    module: str, name: str
) -> None:
    package = import_module(module.partition(".")[0])
    assert getattr(import_module(module), name) is getattr(package, name)


def test_services_and_actions() -> None:
    from example_interfaces.action import Fibonacci
    from example_interfaces.srv import AddTwoInts

    assert AddTwoInts.Request(a=1).a == 1
    assert list(Fibonacci.Goal(order=3).get_fields_and_field_types()) == ["order"]


def test_interface_packages_on_the_interface_path(tmp_path: Path) -> None:
    folder = tmp_path / "hook_msgs" / "msg"
    folder.mkdir(parents=True)
    (folder / "Speed.msg").write_text("float64 mps\n")
    add_interface_path(tmp_path)

    from hook_msgs.msg import Speed

    assert Speed(mps=1.5).mps == 1.5


def test_a_python_package_with_definitions_has_its_modules_and_its_interfaces(
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


def test_a_folder_without_init_does_not_replace_a_module(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "rclpy").mkdir()
    monkeypatch.syspath_prepend(str(tmp_path))

    import rclpy

    assert rclpy.ok is runtime.ok


@pytest.mark.parametrize("name", ["tf2_ros", "launch", "rclpy"])
def test_a_module_beside_the_program_replaces_navettes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    (tmp_path / f"{name}.py").write_text("MINE = True\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    assert import_module(name).MINE
    del sys.modules[name]


class TestInstalledPackages:
    """A package that is installed or on PYTHONPATH, at any place of sys.path."""

    @pytest.fixture(autouse=True)
    def site(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
        self.site = tmp_path
        before = set(sys.modules)
        monkeypatch.setattr(sys, "path", [*sys.path, str(tmp_path)])
        invalidate_caches()
        yield tmp_path
        for name in set(sys.modules) - before:
            del sys.modules[name]

    def package(self, name: str, text: str = "MINE = True\n") -> Path:
        folder = self.site / name
        folder.mkdir(parents=True)
        (folder / "__init__.py").write_text(text)
        return folder

    def test_replaces_navettes(self) -> None:
        folder = self.package("tf_transformations")
        (folder / "extra.py").write_text("from rclpy.time import Time\n")
        assert import_module("tf_transformations").MINE
        assert import_module("tf_transformations.extra").Time is runtime.Time
        assert names.replaced_packages() == {
            "tf_transformations": folder / "__init__.py"
        }

    def test_is_found_by_the_finder_of_an_editable_install(
        self, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        folder = self.package("elsewhere/message_filters")

        class Finder(MetaPathFinder):
            def find_spec(
                self,
                fullname: str,
                path: Sequence[str] | None = None,
                target: ModuleType | None = None,
            ) -> ModuleSpec | None:
                if fullname != "message_filters":
                    return None
                return spec_from_file_location(fullname, folder / "__init__.py")

        monkeypatch.setattr(sys, "meta_path", [*sys.meta_path, Finder()])
        assert import_module("message_filters").MINE

    def test_does_not_replace_what_navette_runs(self) -> None:
        for name in ("launch", "launch_ros", "launch_xml", "launch_yaml"):
            self.package(name)
            assert not hasattr(import_module(name), "MINE")
        assert not names.replaced_packages()

    def test_does_not_replace_message_classes(self) -> None:
        folder = self.package("std_msgs")
        (folder / "msg").mkdir()
        (folder / "msg" / "__init__.py").write_text("class String: ...\n")
        assert import_module("std_msgs").MINE
        assert import_module("std_msgs.msg").String is String

    def test_a_package_of_the_ros_installation_is_not_used(
        self, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        names.uninstall()
        prefix = self.site / "ros"
        packages = prefix / "lib" / "python3" / "site-packages"
        self.site, pip = packages, self.site
        for name in ("rclpy", "tf2_ros", "cv_bridge", "std_msgs"):
            self.package(name)
            (prefix / "share" / name).mkdir(parents=True)
            (prefix / "share" / name / "package.xml").touch()
        self.package("message_filters")  # by pip, into the same folder
        self.site = pip
        self.package("tf_transformations")
        monkeypatch.setattr(sys, "path", [*sys.path, str(packages)])
        names.install(instead_of_ros=True)
        assert import_module("rclpy").init is runtime.init
        assert names.replaced_packages().keys() == {
            "message_filters",
            "tf_transformations",
        }
        for name in ("tf2_ros", "cv_bridge", "std_msgs"):
            assert not hasattr(import_module(name), "MINE")


def test_uninstall_removes_the_names() -> None:
    import rclpy  # noqa: F401 - imported to be removed

    names.uninstall()
    with pytest.raises(ModuleNotFoundError, match="No module named 'rclpy'"):
        import_module("rclpy")


class TestRos2IsInstalled:
    @pytest.fixture(autouse=True)
    def real_rclpy(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        names.uninstall()
        (tmp_path / "rclpy").mkdir()
        (tmp_path / "rclpy" / "__init__.py").write_text("REAL = True\n")
        monkeypatch.syspath_prepend(str(tmp_path))
        monkeypatch.setattr(sys, "path", ["", *sys.path])

    def test_install_raises(self, tmp_path: Path) -> None:
        assert names.installed_rclpy() == tmp_path / "rclpy"
        with pytest.raises(RealRosError, match="rclpy is installed at"):
            names.install()
        assert not names.is_installed()

    def test_navette_replaces_it_on_request(self) -> None:
        names.install(instead_of_ros=True)

        import rclpy

        assert rclpy.init is runtime.init

    def test_an_imported_rclpy_is_not_replaced(
        self, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setitem(sys.modules, "rclpy", ModuleType("rclpy"))
        with pytest.raises(RealRosError, match="imported already from an unknown file"):
            names.install(instead_of_ros=True)


@pytest.mark.slow
def test_the_pytest_plugin_installs_the_hook(tmp_path: Path) -> None:
    (tmp_path / "conftest.py").write_text("import rclpy\n")
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
