"""Shell completion: what is offered, and what is installed where."""

from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from verb_world import World, world

from navette.cli import completing
from navette.cli import completing_installed as installed
from navette.cli.completion import install_script
from navette.cli.topic.options import complete_fields
from navette.msgs.example_interfaces.srv import AddTwoInts
from navette.msgs.std_msgs.msg import String
from navette.runtime import Node
from navette.runtime.lifecycle import LifecycleNode


@pytest.fixture
def here() -> Iterator[World]:
    with world() as here:
        node = here.graph.add(Node("talker", context=here.context))
        node.declare_parameter("speed", 1.0)
        node.create_publisher(String, "chatter", 10)
        node.create_publisher(String, "_own", 10)
        node.create_service(AddTwoInts, "add", lambda request, response: response)
        here.graph.add(LifecycleNode("camera", context=here.context))
        yield here


def typed(node: str) -> Any:
    return SimpleNamespace(params={"node_name": node})


def test_names_of_the_running_system(here: World) -> None:
    assert completing.complete_nodes("") == ["/camera", "/talker"]
    assert completing.complete_nodes("/t") == ["/talker"]
    assert completing.complete_topics("/c") == ["/camera/transition_event", "/chatter"]
    assert completing.complete_topics("/_") == ["/_own"]
    assert completing.complete_services("/a") == ["/add"]
    assert completing.complete_managed_nodes("") == ["/camera"]


def test_a_name_typed_without_its_slash(here: World) -> None:
    assert completing.complete_topics("chat") == ["chatter"]
    assert completing.complete_nodes("t") == ["talker"]


@pytest.mark.parametrize(
    ("shell", "expected"),
    [
        ("bash_complete", ['"{a: 0, b: 0}"']),
        ("fish_complete", ["{a: 0, b: 0}"]),
        ("zsh_complete", ["{a: 0, b: 0}"]),
    ],
)
def test_values_to_edit(
    monkeypatch: pytest.MonkeyPatch, shell: str, expected: list[str]
) -> None:
    monkeypatch.setenv("_NAVETTE_COMPLETE", shell)
    asked: Any = SimpleNamespace(params={"words": ["example_interfaces/AddTwoInts"]})
    assert completing.complete_request(asked, "") == expected
    assert completing.complete_request(asked, "{a") == []
    asked.params["words"].append("{a: 1}")
    assert completing.complete_request(asked, "") == []


def test_a_message_and_a_goal_to_edit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("_NAVETTE_COMPLETE", "bash_complete")
    asked: Any = SimpleNamespace(params={"type_name": "std_msgs/msg/String"})
    assert completing.complete_message_values(asked, "") == ["\"{data: ''}\""]
    asked = SimpleNamespace(params={"words": ["example_interfaces/action/Fibonacci"]})
    assert completing.complete_goal(asked, "") == ['"{order: 0}"']
    asked = SimpleNamespace(params={"type_name": "no such type"})
    assert completing.complete_message_values(asked, "") == []


def test_one_of_a_few_words() -> None:
    assert installed.complete_from("reliable", "best_effort")("r") == ["reliable"]


def test_names_that_a_node_answers(here: World) -> None:
    assert completing.complete_parameters(typed("talker"), "s") == [
        "speed",
        "start_type_description_service",
    ]
    assert completing.complete_transitions(typed("/camera"), "") == [
        "configure",
        "shutdown",
    ]
    assert completing.complete_parameters(typed(""), "") == []
    assert completing.complete_parameters(typed("missing"), "") == []


def test_the_value_of_a_parameter(here: World) -> None:
    def offered(name: str, incomplete: str = "") -> list[str]:
        typed: Any = SimpleNamespace(params={"node_name": "talker", "name": name})
        return completing.complete_parameter_value(typed, incomplete)

    assert offered("speed") == ["1.0"]
    assert offered("use_sim_time") == ["false", "true"]
    assert offered("use_sim_time", "t") == ["true"]
    assert offered("none_such") == offered("") == []


def test_the_fields_of_a_topics_messages(here: World) -> None:
    odometry: Any = SimpleNamespace(params={"type_name": "nav_msgs/Odometry"})
    assert complete_fields(odometry, "tw") == [
        "twist", "twist.covariance", "twist.twist",
    ]  # fmt: skip
    assert complete_fields(odometry, "pose.pose.pos") == [
        "pose.pose.position", "pose.pose.position.x", "pose.pose.position.y",
        "pose.pose.position.z",
    ]  # fmt: skip
    assert complete_fields(odometry, "pose.covariance.x") == []
    assert complete_fields(odometry, "nothing.") == []
    chatter: Any = SimpleNamespace(params={"topic": "chatter"})
    assert complete_fields(chatter, "") == ["data"]
    assert complete_fields(SimpleNamespace(params={}), "") == []  # type: ignore[arg-type]


def test_the_type_of_a_served_name(here: World) -> None:
    served: Any = SimpleNamespace(params={"service": "add"})
    wanted = ["example_interfaces/srv/AddTwoInts"]
    assert completing.complete_type_of_service(served, "") == wanted
    other: Any = SimpleNamespace(params={"service": "other", "action": "other"})
    wanted = ["std_srvs/srv/Empty"]
    assert completing.complete_type_of_service(other, "std_srvs/srv/E") == wanted
    assert "nav2_msgs/action/Spin" in completing.complete_type_of_action(other, "nav2")


def test_installed_names() -> None:
    assert "std_msgs/msg/String" in installed.complete_messages("std_msgs/msg/S")
    assert installed.complete_service_types("std_srvs/srv/E") == ["std_srvs/srv/Empty"]
    assert installed.complete_action_types("example_interfaces/") == [
        "example_interfaces/action/Fibonacci"
    ]
    assert "nav_msgs" in installed.complete_packages("nav")
    assert installed.complete_worlds("ar") == ["arena"]
    assert installed.complete_robots("turtle") == ["turtlebot3_burger"]


@pytest.mark.parametrize(
    ("shell", "script", "settings"),
    [
        ("bash", ".config/navette/completion.bash", ".bashrc"),
        ("zsh", ".config/navette/completion.zsh", ".zshrc"),
    ],
)
def test_installing(tmp_path: Path, shell: str, script: str, settings: str) -> None:
    file = tmp_path / settings
    file.write_text("alias ll='ls -l'")
    assert install_script(shell, tmp_path) == [tmp_path / script, file]
    wanted = f"alias ll='ls -l'\nsource '{tmp_path / script}'\n"
    assert file.read_text() == wanted
    assert install_script(shell, tmp_path) == [tmp_path / script]
    assert file.read_text() == wanted


def test_installing_for_fish(tmp_path: Path) -> None:
    (script,) = install_script("fish", tmp_path)
    assert script == tmp_path / ".config/fish/completions/navette.fish"
    assert "--command navette" in script.read_text()


def test_programs_and_launch_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    package = tmp_path / "src" / "arm"
    (package / "launch").mkdir(parents=True)
    (package / "launch" / "arm.launch.py").touch()
    (package / "package.xml").write_text(
        '<package format="3"><name>arm</name><version>1.0.0</version>'
        "<description>An arm.</description></package>"
    )
    (package / "setup.py").write_text(
        "from setuptools import setup\n"
        "setup(name='arm', entry_points={'console_scripts': ['wave = arm.wave:main']})"
    )
    (tmp_path / "artist.py").touch()
    monkeypatch.chdir(tmp_path)
    nothing: Any = SimpleNamespace(params={})
    of_arm: Any = SimpleNamespace(params={"words": ["arm"]})
    assert installed.complete_programs(nothing, "ar") == ["arbiter", "arm", "artist.py"]
    assert installed.complete_programs(of_arm, "") == ["wave"]
    assert "planner" in installed.complete_programs(nothing, "pl")
    assert installed.complete_launch_files(nothing, "ar") == ["arm"]
    assert installed.complete_launch_files(of_arm, "") == ["arm.launch.py"]
    further: Any = SimpleNamespace(params={"words": ["arm", "wave"]})
    assert installed.complete_programs(further, "") == []
