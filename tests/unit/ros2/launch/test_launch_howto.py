"""The examples of docs/howto/launch.md run."""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from navette.ros2.launch import launch
from navette.ros2.names import install, uninstall

pytestmark = pytest.mark.slow
PAGE = Path(__file__).parents[4] / "docs" / "howto" / "launch.md"
BLOCKS = dict(
    re.findall(r"```(python|yaml|xml)\n(.*?)```", PAGE.read_text("utf-8"), re.DOTALL)
)
TALKER = """
import rclpy
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node("talker")
word = node.declare_parameter("word", "").value
pitch = node.declare_parameter("pitch", 0.0).value
publisher = node.create_publisher(String, "chatter", 10)
node.create_timer(0.01, lambda: publisher.publish(String(data=f"{word} at {pitch}")))
try:
    rclpy.spin(node)
except KeyboardInterrupt:
    pass
"""
LISTENER = """
import rclpy
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node("listener")


def receive(message):
    print("received", message.data, "on", node.resolve_topic_name("chatter"))
    rclpy.shutdown()


node.create_subscription(String, "chatter", receive, 10)
rclpy.spin(node)
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    (tmp_path / "talker.py").write_text(TALKER)
    (tmp_path / "listener.py").write_text(LISTENER)
    (tmp_path / "voice.yaml").write_text("/**: {ros__parameters: {pitch: 2.5}}\n")
    monkeypatch.chdir(tmp_path)
    install()
    yield tmp_path
    uninstall()


@pytest.mark.parametrize(
    ("language", "suffix"), [("python", "py"), ("yaml", "yaml"), ("xml", "xml")]
)
def test_the_example_runs(
    folder: Path, capsys: Any, language: str, suffix: str
) -> None:
    file = folder / f"robot.launch.{suffix}"
    file.write_text(BLOCKS[language])
    assert launch(file, {"word": "salut"}) == 0
    out, err = capsys.readouterr()
    assert "[listener-2] received salut at 2.5 on /robot/speech\n" in out, err
