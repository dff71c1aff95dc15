"""Parameters of nodes in a recording, from /parameter_events."""

from dataclasses import fields
from typing import Any

from navette.bags.play import Source
from navette.msgs import deserialize
from navette.msgs.rcl_interfaces.msg import ParameterEvent
from navette.navigation.stack.stage_classes import node_classes
from navette.runtime import Parameter
from navette.runtime.overrides import ParameterOverrides

_TOPIC = "/parameter_events"
_OF_THE_RUN = ("use_sim_time",)  # set by the run, not by the node


def recorded_parameters(source: Source) -> dict[str, dict[str, Any]]:
    """Return the first parameter values of each node, by its full name.

    Empty if ``/parameter_events`` was not recorded from the start.
    """
    found: dict[str, dict[str, Any]] = {}
    for message in source.messages([_TOPIC]):
        event = deserialize(message.data, ParameterEvent)
        values = found.setdefault(event.node, {})
        for each in event.new_parameters:
            parameter: Parameter[Any] = Parameter.from_parameter_msg(each)
            if parameter.name not in _OF_THE_RUN and parameter.value is not None:
                values.setdefault(parameter.name, parameter.value)
    return {node: values for node, values in found.items() if values}


def give_recorded_parameters(overrides: ParameterOverrides, source: Source) -> None:
    """Add the recorded values as overrides of lowest priority.

    For Navette's own stages, only parameters that still exist.
    """
    if _TOPIC not in (topic.name for topic in source.topics):
        return
    known = {
        f"/{name}": {field.name for field in fields(kind.PARAMS)}
        for name, kind in node_classes()
    }
    for node, values in recorded_parameters(source).items():
        wanted = known.get(node, values.keys())
        kept = {name: value for name, value in values.items() if name in wanted}
        overrides.add(node, kept, f"recorded from {node}")
