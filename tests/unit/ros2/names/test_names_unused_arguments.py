"""Warnings of parameters and remappings that affect no node."""

import re
from pathlib import Path
from typing import Any

import pytest

from navette.msgs.std_msgs.msg import String
from navette.msgs.std_srvs.srv import Trigger
from navette.ros2.names.unused_arguments import warn_of_unused_arguments
from navette.runtime import Context, Node, VirtualClock

FILE = """
/**: {ros__parameters: {common: 1}}
others: {ros__parameters: {a: 1}}
"""


@pytest.mark.parametrize(
    ("words", "warning"),
    [
        ("-p rate:=2.0 -r chatter:=/radio -r __node:=other", None),
        (
            "-p raet:=2.0",
            "unknown parameter 'raet' .*; did you mean 'rate'\\?; known: rate",
        ),
        ("--params-file wrong.yaml", "no node matches '/tlak'; nodes: /ns/talk"),
        ("--params-file stack.yaml", None),
        ("--params-file typo.yaml", "unknown parameter 'raet' for '/ns/talk'"),
        ("-r chattr:=/x", r"remapping chattr:=/x matches no name .*: /ns/\w+, /ns/"),
        ("-r ask:=answer", None),
        ("-r other:chatter:=x", "remapping chatter:=x matches no name"),
    ],
)
def test_warnings(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, words: str, warning: str | None
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("wrong.yaml").write_text("tlak: {ros__parameters: {rate: 2.0}}")
    Path("stack.yaml").write_text(FILE)
    Path("typo.yaml").write_text("/ns/talk: {ros__parameters: {raet: 2.0}}")
    context = Context(clock=VirtualClock())
    context.init(args=["--ros-args", *words.split()])
    logged: list[Any] = []
    context.log.sinks.append(logged.append)
    node = Node("talk", namespace="ns", context=context)
    node.declare_parameter("rate", 1.0)
    node.create_publisher(String, "chatter", 1)
    node.create_service(Trigger, "ask", lambda request, response: response)
    warn_of_unused_arguments(context)
    context.shutdown()
    texts = [each.message for each in logged]
    assert len(texts) == (warning is not None), texts
    if warning is not None:
        assert re.search(warning, texts[0]), texts[0]


def test_without_nodes_there_is_no_warning() -> None:
    with Context(clock=VirtualClock()) as context:
        warn_of_unused_arguments(context)
