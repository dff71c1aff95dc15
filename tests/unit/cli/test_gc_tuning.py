"""Python looks for garbage while a verb works, not while it loads or ends."""

import atexit
import gc
from unittest.mock import patch

import click
import pytest

from navette.cli.app import app
from navette.cli.gc_tuning import collect, uncollected


def test_the_collector_is_off_until_all_is_loaded() -> None:
    assert gc.isenabled()
    with uncollected():
        assert not gc.isenabled()
        collect()
        assert gc.isenabled()


def test_what_was_loaded_is_not_traversed() -> None:
    frozen = gc.get_freeze_count()
    with uncollected():
        collect()
        assert gc.get_freeze_count() > frozen
    assert gc.get_freeze_count() == 0


def test_a_program_that_calls_a_verb_keeps_its_collector() -> None:
    frozen = gc.get_freeze_count()
    collect()
    assert gc.get_freeze_count() == frozen


@pytest.mark.parametrize("verb", ["demo", "sim"])
def test_the_verbs_of_the_stack_load_it_with_the_collector_off(verb: str) -> None:
    with uncollected(), click.Context(app) as context:
        app.resolve_command(context, [verb])
        assert not gc.isenabled()


def test_a_verb_that_ends_early_restores_the_collector() -> None:
    with pytest.raises(SystemExit), uncollected():
        raise SystemExit(2)
    assert gc.isenabled()


def test_the_collector_is_off_at_exit() -> None:
    with patch.object(atexit, "register") as register, uncollected():
        register.assert_called_once_with(gc.freeze)
