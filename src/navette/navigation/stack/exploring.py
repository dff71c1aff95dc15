"""Exploration added to a simulated run, or to a robot that runs elsewhere."""

from collections.abc import Sequence
from typing import Any

from navette.geometry import Footprint
from navette.navigation.missions.explore.node import ExplorerNode
from navette.navigation.stack.simulation import Simulation
from navette.runtime import AsyncParameterClient, Context, Node, Parameter
from navette.runtime.parameter import parameter_value_to_python

# Distance of a goal from obstacles beyond the body's half width.
_MARGIN_M = 0.15
_NAMES = ("map_frame", "base_frame", "footprint_m")


def add_explorer(simulation: Simulation) -> ExplorerNode:
    """Add the explorer to a simulation, with the frames and width of its robot."""
    planner = simulation.stack.planner
    node = make_explorer(
        simulation.context, [planner.get_parameter(name).value for name in _NAMES]
    )
    simulation.executor.add_node(node)
    node.on_done = simulation.stop
    return node


def make_explorer(context: Context, planner_values: Sequence[Any]) -> ExplorerNode:
    """Create the explorer with the planner's map frame, base frame and footprint."""
    map_frame, base_frame, footprint = planner_values
    radius_m = Footprint.from_flat(tuple(footprint)).inscribed_radius
    values = {
        "map_frame": map_frame,
        "base_frame": base_frame,
        "clearance_m": radius_m + _MARGIN_M,
        "passage_m": radius_m,  # whether the body fits is for the planner to decide
    }
    overrides: list[Parameter[Any]] = [
        Parameter(name, value=value) for name, value in values.items()
    ]
    return ExplorerNode(context=context, parameter_overrides=overrides)


def planner_values(node: Node, timeout_s: float) -> "list[Any] | None":
    """Return the values that :func:`make_explorer` takes, from a running planner.

    None if no planner responds in time.
    """
    client = AsyncParameterClient(node, "planner")
    if not client.wait_for_services(timeout_s):
        return None
    future = client.get_parameters(list(_NAMES))
    node.executor.spin_until_future_complete(future, timeout_s)
    response: Any = future.result()
    if response is None:
        return None
    return [parameter_value_to_python(value) for value in response.values]
