"""Entities and callback groups of one node."""

from collections.abc import Iterator
from typing import Any, TypeVar

from navette.runtime.callback_groups import (
    CallbackGroup,
    MutuallyExclusiveCallbackGroup,
    Threads,
)
from navette.runtime.context import Context
from navette.runtime.exceptions import InvalidHandle
from navette.runtime.names import NodeRemapper, full_node_name
from navette.runtime.qos import QoSProfile
from navette.transports import Endpoint, EndpointKind

EntityT = TypeVar("EntityT")

_SERVICE_KINDS = (EndpointKind.SERVICE, EndpointKind.CLIENT)


class NodeEntities:
    """Registry of what a node owns, with the node's names and context.

    The callback groups are held until :meth:`release` and after :meth:`hold`.
    """

    def __init__(self, context: Context, remapper: NodeRemapper) -> None:
        self.context = context
        self.remapper = remapper
        self.full_name = full_node_name(remapper.node_name, remapper.namespace)
        self.is_destroyed = False
        self._entities: dict[Any, None] = {}  # in the order of creation
        self._groups: list[CallbackGroup] = []
        self._is_held = True
        self._threads: Threads | None = None
        self.default_group: CallbackGroup = MutuallyExclusiveCallbackGroup()
        self.adopt(self.default_group)

    def adopt(self, group: CallbackGroup | None) -> CallbackGroup:
        """Return the group (the default one if None) after registering it."""
        if group is None:
            return self.default_group
        if group not in self._groups:
            self._groups.append(group)
            group.ready = self.context.loop.ready
            group.run_in(self._threads)
            if self._is_held:
                group.hold()
        return group

    def release(self, threads: Threads | None) -> None:
        """Let callbacks run, in the threads or in the thread that spins."""
        self._is_held = False
        self._threads = threads
        for group in self._groups:
            group.run_in(threads)
            group.release()

    def hold(self) -> None:
        """Park the events of all callback groups."""
        self._is_held = True
        self._threads = None
        for group in self._groups:
            group.hold()
            group.run_in(None)

    def add(self, entity: Any) -> None:
        self._entities[entity] = None
        group = getattr(entity, "group", None)
        if group is not None:
            group.add_entity(entity)

    def forget(self, entity: Any) -> None:
        """Remove an entity that was destroyed."""
        self._entities.pop(entity, None)
        group = getattr(entity, "group", None) or getattr(
            entity, "callback_group", None
        )
        if group is not None:
            group.remove_entity(entity)

    def destroy(self, entity: Any) -> bool:
        """Destroy an entity; False if the node does not own it."""
        if entity not in self._entities:
            return False
        entity.destroy()
        return True

    def destroy_all(self) -> None:
        self.is_destroyed = True
        for entity in tuple(self._entities):
            entity.destroy()

    def of_type(self, entity_type: type[EntityT]) -> Iterator[EntityT]:
        return (each for each in self._entities if isinstance(each, entity_type))

    def new_endpoint(
        self, kind: EndpointKind, type_name: str, name: str, qos: QoSProfile
    ) -> Endpoint:
        """Return an endpoint of the node with the expanded and remapped name.

        Raises:
            InvalidHandle: the node was destroyed.
        """
        if self.is_destroyed:
            raise InvalidHandle(f"node {self.full_name} was destroyed")
        endpoint = Endpoint(
            kind=kind,
            topic=self.remapper.resolve(name, is_service=kind in _SERVICE_KINDS),
            type_name=type_name,
            qos=qos.to_endpoint_qos(),
            node_name=self.remapper.node_name,
            node_namespace=self.remapper.namespace,
            gid=b"",
        )
        return self.context.graph.with_gid(endpoint)
