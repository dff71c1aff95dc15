"""Classes of nodes by name, and that a run imports no others."""

import subprocess
import sys

import pytest

from navette.errors import UnknownNameError
from navette.navigation.stack.stage_classes import node_class, node_classes

OPTIONAL = ("localization.amcl.node", "localization.ekf.node", "slam.node")


def test_each_name_has_a_class_of_its_own() -> None:
    names, kinds = zip(*node_classes(), strict=True)
    assert len(set(kinds)) == len(set(names)) == len(names)
    stages = dict(node_classes())
    del stages["sim"]
    assert {name: node_class(name) for name in stages} == stages


def test_the_simulator_is_not_a_stage() -> None:
    with pytest.raises(UnknownNameError, match="stage 'sim'"):
        node_class("sim")


def test_a_run_does_not_import_the_nodes_that_it_has_not() -> None:
    code = "import sys, navette.navigation.stack.simulation; print(*sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", code], check=True, capture_output=True, text=True
    )
    loaded = done.stdout.split()
    assert "navette.navigation.stack.simulation" in loaded
    unused = (*OPTIONAL, "missions.explore.node")
    assert not {f"navette.navigation.{name}" for name in unused} & set(loaded)
