"""The parameters that nodes had when they were recorded, as they said themselves."""

from dataclasses import fields
from typing import Any

from navette.bags.play import Source
from navette.msgs import deserialize
from navette.msgs.rcl_interfaces.msg import ParameterEvent
from navette.navigation.stack.stack import NODE_CLASSES
from navette.runtime import Parameter
from navette.runtime.overrides import ParameterOverrides

_TOPIC = "/parameter_events"
_OF_THE_RUN = ("use_sim_time",)  # not of the node's work


def recorded_parameters(source: Source) -> dict[str, dict[str, Any]]:
    """Full name of each node → name and first value of its parameters.

    Empty where ``/parameter_events`` was not recorded, or only from later on.
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
    """Let nodes have the values of the recording, where nothing else is said.

    Of Navette's own stages only parameters that they still have.
    """
    if _TOPIC not in (topic.name for topic in source.topics):
        return
    known = {
        f"/{name}": {field.name for field in fields(kind.PARAMS)}
        for name, kind in NODE_CLASSES
    }
    for node, values in recorded_parameters(source).items():
        wanted = known.get(node, values.keys())
        kept = {name: value for name, value in values.items() if name in wanted}
        overrides.add(node, kept, f"recorded of {node}")
