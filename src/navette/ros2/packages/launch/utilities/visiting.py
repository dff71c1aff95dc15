"""Visits of entities outside a launch service."""

import asyncio
from typing import Any

from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.launch_description_entity import (
    LaunchDescriptionEntity,
)


def visit_all_entities_and_collect_futures(
    entity: LaunchDescriptionEntity, context: LaunchContext
) -> list[tuple[LaunchDescriptionEntity, "asyncio.Future[Any]"]]:
    """Visit an entity and all that it leads to; return the futures to wait for."""
    inside = entity.visit(context)
    future = entity.get_asyncio_future()
    found = [] if future is None else [(entity, future)]
    for each in inside or ():
        found += visit_all_entities_and_collect_futures(each, context)
    return found


def create_future(loop: asyncio.AbstractEventLoop | None) -> "asyncio.Future[Any]":
    """Return a future of a loop, or of the current one."""
    return (loop or asyncio.get_event_loop()).create_future()
