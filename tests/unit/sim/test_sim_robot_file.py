"""Robots described by sizes in a YAML file, and robots of installed packages."""

import importlib
from pathlib import Path

import pytest

from navette.errors import FileFormatError, InvalidValueError, NavetteError
from navette.geometry import Pose2, yaw_of
from navette.sim import Simulator, World, derive_parameters, footprint_of, load_robot


def written(folder: Path, text: str, name: str = "cart.yaml") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize("name", ["cart.yaml", "names.yaml"])
def test_a_file_that_is_not_text_is_refused(tmp_path: Path, name: str) -> None:
    cart = written(tmp_path, "{}")
    (tmp_path / name).write_bytes(b"\x89PNG\xff\x00")
    with pytest.raises(FileFormatError, match=rf"{name}: not YAML"):
        load_robot(cart)


@pytest.mark.parametrize(
    "text",
    [
        "{}",
        "is_round: true\nlength_m: 0.36\n",
        "length_m: 0.9\nwidth_m: 0.6\naxle_x_m: -0.3\nmass_kg: 60\n",
        "length_m: 0.9\naxle_x_m: 0.35\nwheel_radius_m: 0.2\n",
    ],
)
def test_a_robot_of_sizes_stands_and_drives_straight(tmp_path: Path, text: str) -> None:
    robot = load_robot(written(tmp_path, text))
    scene = World("empty").add_robot(robot.model).scene()
    simulator = Simulator(scene, start=Pose2(0.0, 0.0, 0.0))
    for _ in range(300):
        simulator.command(0.4, 0.0)
        simulator.advance_to(simulator.now_ns + 10_000_000)
    pose = simulator.pose()
    assert simulator.contacts.count == 0
    assert pose.translation[0] > 0.8
    assert abs(pose.translation[1]) < 0.02
    assert abs(pose.translation[2]) < 0.01
    assert abs(yaw_of(pose.rotation)) < 0.02


def test_sizes_limits_and_parameters_are_those_of_the_file(tmp_path: Path) -> None:
    text = """
        length_m: 0.6
        width_m: 0.4
        max_speed_mps: 1.5
        lidar_fov_deg: 180
        parameters:
          control: {cruise_speed_mps: 0.9}
    """
    robot = load_robot(written(tmp_path, text))
    assert robot.name == "cart"
    assert robot.parameters == {"control": {"cruise_speed_mps": 0.9}}
    xs = [x for x, _ in footprint_of(robot.model)]
    assert max(xs) == pytest.approx(0.3)
    assert derive_parameters(robot.model)["sim"]["max_speed_mps"] == 1.5


def test_a_model_file_gets_the_parameters(tmp_path: Path) -> None:
    path = written(tmp_path, "model: jackal.sdf\nparameters: {planner: {a: 1}}\n")
    with pytest.raises(FileFormatError, match=r"model: .*jackal\.sdf: no such file"):
        load_robot(path)
    source = Path(load_robot.__code__.co_filename).parent / "data/robots/jackal"
    text = (source / "model.sdf").read_text(encoding="utf-8")
    written(tmp_path, text, "jackal.sdf")
    robot = load_robot(path)
    assert robot.model.name == "jackal"
    assert robot.parameters == {"planner": {"a": 1}}


@pytest.mark.parametrize(
    ("text", "match"),
    [
        ("lenght_m: 1", "unknown parameter 'lenght_m'; did you mean 'length_m'\\?"),
        ("length_m: -1", r"'length_m': -1.0 is not allowed; must be > 0 m"),
        ("length_m: big", "'length_m': 'big' is str, expected float"),
        ("axle_x_m: 3", "axle_x_m.*within"),
        ("- 1", "expected lines"),
        ("parameters: 3", "expected NODE"),
        ("model: a.sdf\nlength_m: 1", "beside model: length_m"),
        ("{", "not YAML"),
    ],
)
def test_mistakes_are_named(tmp_path: Path, text: str, match: str) -> None:
    with pytest.raises(FileFormatError, match=match):
        load_robot(written(tmp_path, text))


def test_installed_packages_offer_robots(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    written(tmp_path, "length_m: 0.7\n")
    code = f"def cart():\n    return {str(tmp_path / 'cart.yaml')!r}\nwrong = 3\n"
    written(tmp_path, code, "robots_of_a_package.py")
    info = tmp_path / "robots_of_a_package-1.0.dist-info"
    info.mkdir()
    written(info, "Name: robots_of_a_package\nVersion: 1.0\n", "METADATA")
    points = "one = robots_of_a_package:cart\ntwo = robots_of_a_package:wrong\n"
    written(info, f"[navette.robots]\n{points}", "entry_points.txt")
    monkeypatch.syspath_prepend(tmp_path)
    importlib.invalidate_caches()
    robot = load_robot("one")
    assert robot.name == "one"
    assert max(x for x, _ in footprint_of(robot.model)) == pytest.approx(0.35)
    with pytest.raises(InvalidValueError, match="expected the path of a model"):
        load_robot("two")
    with pytest.raises(NavetteError, match=r"known: .*one,.* two"):
        load_robot("three")
