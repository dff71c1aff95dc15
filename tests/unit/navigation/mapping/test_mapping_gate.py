import dataclasses

import numpy as np
import pytest

from navette.geometry import Pose2
from navette.navigation.grids import GridSpec, placed
from navette.navigation.mapping import (
    BodyMotion,
    FusionGate,
    MapMemory,
    MapMemoryParams,
    PlacedCostmap,
)

SPEC = GridSpec(0.1, 41, 41, Pose2(-2.05, -2.05, 0.0))
SECOND = 1_000_000_000


def costmap(x=0.0, yaw=0.0, *, obstacle=False, **motion) -> PlacedCostmap:
    cells = np.zeros(SPEC.shape, np.int8)
    if obstacle:
        cells[15:25, 35] = 100
    pose = Pose2(x, 0.0, yaw)
    return PlacedCostmap(
        cells, placed(SPEC, pose), (x, 0.0), pose, 0, BodyMotion(**motion)
    )


def gate_and_memory(**values) -> tuple[FusionGate, MapMemory]:
    params = MapMemoryParams(**values)
    return FusionGate(params), MapMemory(params)


def fused_once(first: PlacedCostmap, **values) -> tuple[FusionGate, MapMemory]:
    gate, memory = gate_and_memory(**values)
    memory.fuse(first)
    gate.fused(first, 0)
    return gate, memory


def test_the_first_costmap_is_fused_at_once() -> None:
    gate, memory = gate_and_memory()
    assert gate.on_arrival(costmap(), memory, 0)
    assert gate.on_timer(costmap(), memory)


@pytest.mark.parametrize(
    ("x", "yaw", "expected"),
    [(0.5, 0.0, False), (1.6, 0.0, True), (0.0, 0.4, False), (0.0, -0.6, True)],
)
def test_the_timer_waits_for_distance_or_turn(x, yaw, expected) -> None:
    """Gating by distance alone would never fuse during a turn."""
    gate, memory = fused_once(costmap())
    assert gate.on_timer(costmap(x, yaw), memory) is expected


def test_the_timer_waits_for_a_cell_while_obstacles_vanish() -> None:
    gate, memory = fused_once(costmap(), fuse_on_change=False)
    seen = dataclasses.replace(
        costmap(obstacle=True),
        hits=np.array([(1.5, y) for y in np.arange(-0.5, 0.5, 0.02)]),
    )
    behind = np.array([(2.0, y) for y in np.arange(-0.8, 0.8, 0.01)])
    for each in (seen, dataclasses.replace(costmap(), hits=behind)):
        memory.fuse(each)
        gate.fused(each, 0)
    assert memory.vanishing >= memory.params.change_cells
    assert not gate.on_timer(costmap(0.05), memory)
    assert gate.on_timer(costmap(0.15), memory)


def test_the_same_costmap_is_not_fused_twice() -> None:
    first = costmap()
    gate, memory = fused_once(first, update_distance_m=0.0)
    assert not gate.on_timer(first, memory)
    assert gate.on_timer(costmap(), memory)


def test_nothing_is_fused_while_spinning() -> None:
    gate, memory = gate_and_memory()
    assert not gate.on_arrival(costmap(yaw_rate=-2.0), memory, 0)
    gate, memory = fused_once(costmap())
    spinning = costmap(3.0, 1.0, yaw_rate=2.0, obstacle=True)
    assert not gate.on_timer(spinning, memory)
    assert not gate.on_arrival(spinning, memory, SECOND)


@pytest.mark.parametrize(
    "motion", [{"vertical_speed": -1.0}, {"vertical_speed": 1.0}, {"tilt": 0.3}]
)
def test_nothing_is_fused_while_falling_or_tilted(motion) -> None:
    gate, memory = gate_and_memory()
    assert not gate.on_arrival(costmap(**motion), memory, 0)
    assert not gate.on_timer(costmap(**motion), memory)
    assert gate.on_arrival(costmap(vertical_speed=-0.1, tilt=0.05), memory, 0)


def test_a_stationary_robot_fuses_what_appeared_at_once() -> None:
    gate, memory = fused_once(costmap())
    assert not gate.on_arrival(costmap(), memory, SECOND)
    assert gate.on_arrival(costmap(obstacle=True), memory, SECOND)


def test_a_stationary_robot_fuses_what_moved_away_at_once() -> None:
    gate, memory = fused_once(costmap(obstacle=True))
    assert not gate.on_arrival(costmap(obstacle=True), memory, SECOND)
    assert gate.on_arrival(costmap(), memory, SECOND)


def test_what_vanished_beside_an_obstacle_that_stands_waits_for_the_timer() -> None:
    """Of a wall, mostly single echoes: a map a second shows it soon enough."""
    wall = costmap(obstacle=True)
    with_echoes = dataclasses.replace(wall, cells=wall.cells.copy())
    with_echoes.cells[17:22, 32] = 100  # less than 0.3 m before it
    gate, memory = fused_once(with_echoes)
    assert not gate.on_timer(with_echoes, memory)
    assert not gate.on_arrival(wall, memory, SECOND)
    assert gate.on_timer(wall, memory)
    gate, memory = fused_once(with_echoes, fuse_on_change=False)
    assert not gate.on_timer(wall, memory)


def test_changes_are_rate_limited_and_can_be_switched_off() -> None:
    gate, memory = fused_once(costmap(), change_period_s=0.3)
    changed = costmap(obstacle=True)
    assert not gate.on_arrival(changed, memory, 299_999_999)
    assert gate.on_arrival(changed, memory, 300_000_000)
    gate, memory = fused_once(costmap(), fuse_on_change=False)
    assert not gate.on_arrival(changed, memory, SECOND)


def test_few_changed_cells_are_noise() -> None:
    gate, memory = fused_once(costmap(), change_cells=11)
    assert not gate.on_arrival(costmap(obstacle=True), memory, SECOND)


def test_after_reset_the_next_costmap_is_the_first() -> None:
    gate, memory = fused_once(costmap())
    gate.reset()
    assert gate.on_arrival(costmap(), memory, 0)
