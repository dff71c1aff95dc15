"""A traceback shows the program's lines; Navette's only where that is to blame."""

import pytest

import navette
from navette.errors import CallbackError
from navette.ros2.names.tracebacks import shortened
from navette.testing import GraphHarness

PROGRAM = """
def tick():
    raise RuntimeError("motor on fire")


def main(graph, node):
    node.create_timer(0.1, tick)
    graph.run_for(0.2)
"""


def printed(error: BaseException) -> str:
    return "".join(shortened(error, error.__traceback__).format())


def test_a_callback_that_raises_shows_where() -> None:
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


def test_what_navette_refuses_shows_who_asked() -> None:
    with pytest.raises(navette.errors.NavetteError) as caught:
        navette.QoSProfile(depth=-1)
    text = printed(caught.value)
    assert "navette.QoSProfile(depth=-1)" in text
    assert text.count("File ") == 1


def test_a_fault_within_navette_is_shown_whole() -> None:
    with pytest.raises(AttributeError) as caught:
        navette.Node.get_name(None)  # type: ignore[arg-type]
    assert printed(caught.value).count("File ") == 2
