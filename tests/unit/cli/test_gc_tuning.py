"""Python looks for garbage while a verb works, not while it loads or ends."""

import atexit
import gc
from unittest.mock import patch

import pytest

from navette.cli.gc_tuning import collect, uncollected


def test_the_collector_is_off_until_all_is_loaded() -> None:
    assert gc.isenabled()
    with uncollected():
        assert not gc.isenabled()
        collect()
        assert gc.isenabled()


def test_a_verb_that_ends_early_restores_the_collector() -> None:
    with pytest.raises(SystemExit), uncollected():
        raise SystemExit(2)
    assert gc.isenabled()


def test_the_collector_is_off_at_exit() -> None:
    with patch.object(atexit, "register") as register, uncollected():
        register.assert_called_once_with(gc.freeze)
