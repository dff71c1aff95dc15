"""The commander: who moves the robot, as the arbiter publishes it on /commander."""

from typing import NamedTuple, Self

from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus

EMERGENCY_STOP = "emergency_stop"


class Commander(NamedTuple):
    """Who commands, and the topics whose commands do not count meanwhile.

    Without an arbiter nothing is masked.
    """

    name: str = ""
    masked_topics: frozenset[str] = frozenset()
    #: Nodes that publish the commands.
    nodes: tuple[str, ...] = ()

    @classmethod
    def of(cls, msg: DiagnosticStatus) -> Self:
        values = {pair.key: pair.value for pair in msg.values}
        masked = filter(None, values.get("masked_topics", "").split(","))
        nodes = tuple(filter(None, values.get("nodes", "").split(",")))
        return cls(msg.message, frozenset(masked), nodes)

    @property
    def is_stopped(self) -> bool:
        """Whether the emergency stop is engaged."""
        return self.name == EMERGENCY_STOP

    @property
    def text(self) -> str:
        """The commander for people: its name, and the nodes that publish for it."""
        nodes = ", ".join(node.lstrip("/") for node in self.nodes)
        name = self.name.replace("_", " ")
        return f"{name} ({nodes})" if nodes else name

    def masks(self, topic: str) -> bool:
        """Whether commands on a topic (its full name) do not reach the wheels."""
        return topic in self.masked_topics


NO_COMMANDER = Commander()
"""Before the arbiter has published, and without one."""
