"""Tracebacks show the program's lines, and Navette's for internal errors only."""

import pytest

import navette
from navette.errors import CallbackError
from navette.ros2.names.tracebacks import shortened
from navette.runtime.testing import GraphHarness

PROGRAM = """
def tick():
    raise RuntimeError("motor on fire")


def main(graph, node):
    node.create_timer(0.1, tick)
    graph.run_for(0.2)
"""


def printed(error: BaseException) -> str:
    return "".join(shortened(error, error.__traceback__).format())


def test_an_exception_in_a_callback_shows_the_programs_lines() -> None:
    names: dict[str, object] = {}
    exec(compile(PROGRAM, "motor.py", "exec"), names)
    main = names["main"]
    assert callable(main)
    with GraphHarness() as graph:
        node = graph.add(navette.Node("motor", context=graph.context))
        with pytest.raises(CallbackError) as caught:
            main(graph, node)
    text = printed(caught.value)
    assert 'File "motor.py", line 3, in tick' in text
    assert 'File "motor.py", line 8, in main' in text
    assert text.rstrip().endswith("RuntimeError: motor on fire")
    assert "loop.py" not in text


def test_a_failed_check_shows_the_call() -> None:
    with pytest.raises(navette.errors.NavetteError) as caught:
        navette.QoSProfile(depth=-1)
    text = printed(caught.value)
    assert "navette.QoSProfile(depth=-1)" in text
    assert text.count("File ") == 1


def test_the_traceback_of_an_internal_error_is_complete() -> None:
    with pytest.raises(AttributeError) as caught:
        navette.Node.get_name(None)  # type: ignore[arg-type]
    assert printed(caught.value).count("File ") == 2
