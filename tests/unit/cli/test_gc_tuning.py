"""Python looks for garbage while a verb works, not while it loads or ends."""

import atexit
import gc
from unittest.mock import patch

import pytest

from navette.cli.gc_tuning import collect, uncollected


def test_none_is_looked_for_until_all_is_loaded() -> None:
    assert gc.isenabled()
    with uncollected():
        assert not gc.isenabled()
        collect()
        assert gc.isenabled()


def test_a_verb_that_loads_nothing_more_leaves_all_as_it_was() -> None:
    with pytest.raises(SystemExit), uncollected():
        raise SystemExit(2)
    assert gc.isenabled()


def test_at_the_end_none_is_looked_for() -> None:
    with patch.object(atexit, "register") as register, uncollected():
        register.assert_called_once_with(gc.freeze)
