"""The forms of a program on the command line of ``navette run``."""

from pathlib import Path

import pytest

from navette.errors import InvalidValueError, UnknownNameError
from navette.ros2.names import targets
from navette.ros2.names.targets import find_sources, read_programs, uncalled_main
from navette.ros2.workspace.create import create_package


@pytest.fixture
def talker(tmp_path: Path) -> Path:
    path = tmp_path / "talker.py"
    path.write_text("")
    return path


def test_a_file_with_arguments(talker: Path) -> None:
    (program,) = read_programs([str(talker), "--ros-args", "-r", "a:=b"])
    assert program.argv == [str(talker), "--ros-args", "-r", "a:=b"]
    assert program.path == (talker.parent,)


def test_a_file_inside_a_package_finds_its_siblings_by_full_name(
    tmp_path: Path,
) -> None:
    package = tmp_path / "robot"
    package.mkdir()
    (package / "__init__.py").write_text("")
    (package / "node.py").write_text("")
    (program,) = read_programs([str(package / "node.py")])
    assert program.path == (package, tmp_path)


def test_a_file_does_not_hide_a_stage_of_the_same_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("planner", "drive"):
        (tmp_path / name).write_text("raise LookupError('the file')")
    (file,) = read_programs(["./planner"])
    with pytest.raises(LookupError, match="the file"):
        file.main()
    monkeypatch.delattr(targets, "script")  # must not be called
    assert read_programs(["planner"])[0].name == "planner"
    assert find_sources(["planner"]) == []
    assert find_sources(["./planner"]) == [Path("planner")]
    with pytest.raises(InvalidValueError, match=r"a program \(./drive runs the file"):
        read_programs(["drive"])


def test_several_programs_each_with_its_arguments(talker: Path) -> None:
    programs = read_programs(
        [str(talker), "-x", "--", "y", "--with", "robots:Listener", "-z"]
    )
    assert [program.argv for program in programs] == [
        [str(talker), "-x", "--", "y"],
        ["robots:Listener", "-z"],
    ]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ([], "a program is missing; expected FILE"),
        (["a:B", "--with"], "a program is missing"),
        (["missing.py"], r"missing\.py: no such file"),
        (["missing.py:Node"], r"missing\.py: no such file"),
        (["talker"], "'talker' is not a program; expected FILE"),
    ],
)
def test_another_form_is_an_error(words: list[str], message: str) -> None:
    with pytest.raises(InvalidValueError, match=message):
        read_programs(words)


def test_an_executable_of_a_package(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (made,) = create_package("my_robot", tmp_path, node="drive")
    monkeypatch.chdir(made / "launch")
    (program,) = read_programs(["my_robot", "drive", "-x"])
    assert program.argv == ["drive", "-x"]
    assert program.path == (made,)
    with pytest.raises(UnknownNameError, match="executable of my_robot 'd'"):
        read_programs(["my_robot", "d"])
    with pytest.raises(UnknownNameError, match="'yours' not found"):
        read_programs(["yours", "drive"])


@pytest.mark.parametrize(
    ("text", "is_advised"),
    [
        ("def main(): pass\n", True),
        ("def main(): pass\nmain()\n", False),
        ("def main(): pass\nif __name__ == '__main__': main()\n", False),
        ("print('hi')\n", False),
        ("def main(:\n", False),
    ],
)
def test_a_main_that_is_not_called(tmp_path: Path, text: str, is_advised: bool) -> None:
    file = tmp_path / "talker.py"
    file.write_text(text)
    advice = uncalled_main([str(file)])
    assert (advice is not None) == is_advised
    assert not is_advised or f"navette run {file}:main" in str(advice)
