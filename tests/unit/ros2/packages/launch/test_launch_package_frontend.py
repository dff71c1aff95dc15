"""The same launch in XML and in YAML becomes the same actions."""

from pathlib import Path
from typing import Any

import pytest

from navette.ros2.packages.launch import LaunchContext
from navette.ros2.packages.launch.actions import IncludeLaunchDescription
from navette.ros2.packages.launch.errors import InvalidLaunchFileError
from navette.ros2.packages.launch.frontend import (
    parse_launch_file,
    parse_launch_text,
    parse_substitution,
)
from navette.runtime.parameter_files import read_parameter_file

XML = """<launch version="0.1.1">
  <arg name="robot" default="burger" description="which">
    <choice value="burger"/>
    <choice value="waffle"/>
  </arg>
  <arg name="count" default="$(eval '1 + 2')"/>
  <let name="both" value="$(var robot)$(var count)"/>
  <set_env name="NAVETTE_X" value="x"/>
  <log message="robot is $(var both)"/>
  <group>
    <push_ros_namespace namespace="$(var robot)"/>
    <set_parameter name="shared" value="1.5"/>
    <set_remap from="a" to="b"/>
    <node pkg="demo" exec="talker" name="t" namespace="in" output="screen"
          args="-x 'a b' $(var count)" ros_args="--log-level debug"
          respawn="true" respawn_delay="2.0" respawn_max_retries="1"
          if="$(equals $(var robot) burger)">
      <param name="word" value="hello"/>
      <param name="number" value="$(var count)"/>
      <param name="text" value="3" type="str"/>
      <param name="list" value="1,2" value-sep=","/>
      <param name="deep"><param name="inner" value="true"/></param>
      <remap from="chatter" to="/talk"/>
      <env name="Y" value="y"/>
    </node>
  </group>
  <executable cmd="tool --flag $(var robot)" cwd="." name="named" shell="false"/>
  <timer period="1.5"><log message="late"/></timer>
</launch>"""

YAML = """launch:
- arg:
    name: robot
    default: burger
    description: which
    choice:
    - value: burger
    - value: waffle
- arg: {name: count, default: "$(eval '1 + 2')"}
- let: {name: both, value: $(var robot)$(var count)}
- set_env: {name: NAVETTE_X, value: x}
- log: {message: robot is $(var both)}
- group:
  - push_ros_namespace: {namespace: $(var robot)}
  - set_parameter: {name: shared, value: 1.5}
  - set_remap: {from: a, to: b}
  - node:
      pkg: demo
      exec: talker
      name: t
      namespace: in
      output: screen
      args: -x 'a b' $(var count)
      ros_args: --log-level debug
      respawn: true
      respawn_delay: 2.0
      respawn_max_retries: 1
      if: $(equals $(var robot) burger)
      param:
      - {name: word, value: hello}
      - {name: number, value: $(var count)}
      - {name: text, value: "3"}
      - {name: list, value: [1, 2]}
      - name: deep
        param:
        - {name: inner, value: true}
      remap:
      - {from: chatter, to: /talk}
      env:
      - {name: Y, value: y}
- executable: {cmd: tool --flag $(var robot), cwd: ., name: named, shell: false}
- timer:
    period: 1.5
    children:
    - log: {message: late}
"""


@pytest.fixture
def demo(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A workspace with a package ``demo``, where one stands."""
    folder = tmp_path / "demo"
    (folder / "launch").mkdir(parents=True)
    (folder / "package.xml").write_text(
        "<package format='3'><name>demo</name><version>1.0.0</version>"
        "<description>d</description><maintainer email='a@b.org'>a</maintainer>"
        "<license>MIT</license></package>"
    )
    (folder / "setup.py").write_text(
        "from setuptools import setup\nsetup(name='demo', entry_points={"
        "'console_scripts': ['talker = demo.talker:main']})\n"
    )
    monkeypatch.chdir(tmp_path)
    return folder


@pytest.mark.parametrize(("ending", "text"), [("xml", XML), ("yaml", YAML)])
def test_a_file_with_all_tags(
    launch: Any, caplog: Any, demo: Path, ending: str, text: str
) -> None:
    file = demo / "launch" / f"all.launch.{ending}"
    file.write_text(text)
    launch.runner.behaviour = lambda p: p.listener.exited(0)
    code = launch.run(IncludeLaunchDescription(str(file)), robot="burger")
    assert code == 0, launch.errors
    node, tool = launch.runner.started[0], launch.runner.started[1]
    assert node.command.label == "talker-1"
    words = node.command.words
    files = [Path(words[i + 1]) for i, w in enumerate(words) if w == "--params-file"]
    assert [word for word in words if Path(word) not in files] == [
        "talker", "-x", "a b", "3",
        "--ros-args", "--log-level", "debug", "--ros-args",
        "-r", "__node:=t", "-r", "__ns:=/burger/in",
        "-p", "shared:=1.5", *["--params-file"] * 5,
        "-r", "a:=b", "-r", "chatter:=/talk",
    ]  # fmt: skip
    values: dict[str, Any] = {}
    for file in files:
        ((name, own),) = read_parameter_file(file)
        assert name == "/burger/in/t"
        values |= own
    assert values == {
        "word": "hello", "number": 3, "text": "3", "list": [1, 2], "deep.inner": True,
    }  # fmt: skip
    assert node.command.env["Y"] == "y"
    assert node.command.env["NAVETTE_X"] == "x"
    assert tool.command.words == ["tool", "--flag", "burger"]
    assert tool.command.label == "named-2"
    assert "robot is burger3" in caplog.text
    assert "late" in caplog.text
    assert launch.labels == ["talker-1", "named-2", "talker-3"]
    assert launch.runner.started[2].at_s == 2.0
    described = parse_launch_file(
        demo / "launch" / f"all.launch.{ending}"
    ).get_launch_arguments()
    assert [a.name for a in described] == ["robot", "count"]
    assert described[0].choices == ["burger", "waffle"]


@pytest.mark.parametrize(
    ("xml", "line", "reason"),
    [
        ("<launch>\n<nod pkg='a'/>\n</launch>", 2, "<nod>: unknown tag; .*node"),
        ("<launch>\n\n<node pkg='a'/></launch>", 3, "<node>: attribute 'exec' is mis"),
        ("<launch><node pkg='a' exec='b' ouput='s'/></launch>", 1, "'ouput' of .*out"),
        ("<launch><node pkg='a' type='b' name='c'/></launch>", 1, "ROS 1; write exec"),
        ("<launch><rosparam file='a'/></launch>", 1, "<rosparam>: a tag of ROS 1"),
        ("<launch><log message='$(find a)'/></launch>", 1, "find-pkg-share"),
        ("<launch><log message='$(vra x)'/></launch>", 1, r"unknown subst.*'\$\(vra"),
        ("<launch><log message='$(var x'/></launch>", 1, r"closing '\)' is missing"),
        ("<launch><log message='$(var)'/></launch>", 1, "0 arguments; expected 1 to 2"),
        ("<launch><log message='a' if='1' unless='1'/></launch>", 1, "exclusive"),
        ("<launch><node pkg='a' exec='b'>\n<remp from='a' to='b'/></node></launch>", 2,
         "<remp>: not allowed in `node`; allowed: .*<remap>"),
        ("<launch>text</launch>", 1, "unexpected text 'text'"),
        ("<run/>", 1, "expected <launch>"),
        ("<launch>", 1, "not XML"),
        ("<!DOCTYPE x [<!ENTITY a 'b'>]><launch/>", None, "refused: DTDForbidden"),
        ("<launch><executable cmd='a' respawn_delay='x'/></launch>", 1, "a number"),
        ("<launch><executable cmd='a' on_exit='x'/></launch>", 1, "expected shutdown"),
        ("<launch><group scoped='x'/></launch>", 1, "expected true or false"),
        ("<launch><set_parameter name='x' value='1' type='i'/></launch>", 1, "of bool"),
        ("<launch><node pkg='a' exec='b'><param name='x'/></node></launch>", 1, "valu"),
    ],
)  # fmt: skip
def test_an_error_names_file_and_line(
    tmp_path: Path, xml: str, line: int | None, reason: str
) -> None:
    file = tmp_path / "a.launch.xml"
    file.write_text(xml)
    where = f"a.launch.xml{'' if line is None else f':{line}'}: "
    with pytest.raises(InvalidLaunchFileError, match=f"{where}.*{reason}"):
        parse_launch_file(file)


@pytest.mark.parametrize(
    ("text", "line", "reason"),
    [
        ("launch:\n- node:\n    pkg: a\n", 2, "<node>: attribute 'exec' is missing"),
        ("launch:\n- log: {message: a, lvel: b}\n", 2, "'lvel'"),
        ("launch:\n- {a: {}, b: {}}\n", 2, "one tag each"),
        ("launch: [\n", 2, "not YAML"),
        ("- a\n", None, "'launch:'"),
        ("launch:\n- log: text\n", 2, "expected attributes"),
        ("launch:\n- log: {message: a, message: b}\n", 2, "given more than once"),
        ("launch:\n- log: {message: !!python/object:os.system a}\n", None, "not YAML"),
    ],
)  # fmt: skip
def test_an_error_in_yaml(
    tmp_path: Path, text: str, line: int | None, reason: str
) -> None:
    file = tmp_path / "a.launch.yaml"
    file.write_text(text)
    where = "a.launch.yaml" if line is None else f"a.launch.yaml:{line}: "
    with pytest.raises(InvalidLaunchFileError, match=f"{where}.*({reason})"):
        parse_launch_file(file)


def test_an_invalid_condition_names_its_tag(launch: Any, tmp_path: Path) -> None:
    file = tmp_path / "a.launch.xml"
    file.write_text("<launch>\n<log message='a' if='$(var missing)'/>\n</launch>")
    launch.run(IncludeLaunchDescription(str(file)))
    assert f"{file}:2: LogInfo('a'): launch configuration 'missing'" in launch.errors


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("plain", "'plain'"),
        ("", "''"),
        ("a$(var b)c", "'a' + LaunchConfiguration('b') + 'c'"),
        ("$(var $(env N a))", "LaunchConfiguration(EnvironmentVariable('N'))"),
        (r"\$(var b)", "'$(var b)'"),
        ("cost: 5$", "'cost: 5$'"),
        ("$(eval '\"$(var a)\"<1')",
         "PythonExpr('\"' + LaunchConfiguration('a') + '\"<1', ['math'])"),
        ("$(eval 1 + $(var b))",
         "PythonExpr('1' + ' ' + '+' + ' ' + LaunchConfiguration('b'), ['math'])"),
        ("$(find-exec \"a b\")", "FindExecutable('a b')"),
        ("$(not true)", "NotSubstitution('true')"),
    ],
)  # fmt: skip
def test_the_grammar(text: str, parts: str) -> None:
    assert parse_substitution(text).describe() == parts


def test_nesting_is_bounded() -> None:
    with pytest.raises(ValueError, match="nested deeper"):
        parse_substitution("$(var " * 100 + "a" + ")" * 100)
    deep = b"launch: " + b"[" * 3000 + b"]" * 3000
    with pytest.raises(ValueError, match=r"nested deeper|maximum nesting"):
        parse_launch_text(deep, Path("a.yaml"), ".yaml")


def test_includes_of_other_formats(
    launch: Any, caplog: Any, tmp_path: Path, context: LaunchContext
) -> None:
    (tmp_path / "b.launch.yaml").write_text(
        "launch:\n- arg: {name: x}\n- log: {message: $(var x) $(dirname)}\n"
    )
    (tmp_path / "a.launch.xml").write_text(
        "<launch><include file='$(dirname)/b.launch.yaml'>"
        "<arg name='x' value='given'/></include></launch>"
    )
    code = launch.run(IncludeLaunchDescription(str(tmp_path / "a.launch.xml")))
    assert code == 0, launch.errors
    assert f"given {tmp_path}" in caplog.text


@pytest.fixture
def context(launch: Any) -> LaunchContext:
    found: LaunchContext = launch.context
    return found


def test_the_expansion_of_aliases_is_limited(
    tmp_path: Path,
) -> None:
    lines = ["launch:", "- group: &a0 [{log: {message: x}}]"]
    for i in range(1, 12):
        inside = ", ".join([f"{{group: *a{i - 1}}}"] * 9)
        lines.append(f"- group: &a{i} [{inside}]")
    file = tmp_path / "a.launch.yaml"
    file.write_text("\n".join(lines))
    with pytest.raises(InvalidLaunchFileError, match="more than 100000 items"):
        parse_launch_file(file)
