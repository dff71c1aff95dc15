"""Publish messages given as YAML, once or at a rate."""

from collections.abc import Callable
from typing import Any

from navette.cli.message_types import topic_class
from navette.cli.nearest import did_you_mean
from navette.cli.output import is_terminal, show
from navette.cli.request_builder import from_stdin, from_yaml, from_yaml_file
from navette.cli.session import (
    endpoints,
    fail,
    follow_clock,
    is_simulated,
    wait_for,
)
from navette.cli.stderr import note
from navette.cli.topic.pub_options import PublishOptions
from navette.cli.topic.qos_profiles import overridden_profile
from navette.errors import InvalidValueError
from navette.msgs import type_name
from navette.msgs.interface import Field
from navette.msgs.registry import get_message_spec
from navette.msgs.values import shortened
from navette.ros2.packages.rosidl_runtime_py import set_message_fields
from navette.runtime import Clock, Node, Publisher
from navette.runtime.time import ClockType
from navette.transports import EndpointKind

_LONGEST_ON_TERMINAL = 2000
_CLOCK_TIMEOUT_S = 2.0

Stamp = Callable[[Any], None]


def publish(node: Node, options: PublishOptions) -> None:
    """Publish until the requested number of messages is sent."""
    cls = topic_class(node, options.topic, options.type_name)
    messages = [filled_message(cls, values) for values in _typed(options)]
    limit = options.limit
    if options.yaml_file is not None:
        limit = min(limit or len(messages), len(messages))
    profile = overridden_profile(options.qos, "default")
    publisher = node.create_publisher(cls, options.topic, profile)
    _wait_for_subscriptions(node, publisher, options)
    if (
        any(stamps for _, stamps in messages)
        and not options.wall_time
        and is_simulated(node)
    ):
        follow_clock(node)
        wait_for(node, lambda: node.get_clock().now_ns > 0, _CLOCK_TIMEOUT_S)
    show("publisher: beginning loop")
    count = 0

    def send() -> None:
        nonlocal count
        if limit and count >= limit:
            return
        message, stamps = messages[count % len(messages)]
        now = node.get_clock().now().to_msg()
        for stamp in stamps:
            stamp(now)
        count += 1
        if options.print_each and count % options.print_each == 0:
            show(f"publishing #{count}: {_shown(message)}\n")
        publisher.publish(message)

    send()
    clock = Clock(clock_type=ClockType.STEADY_TIME, context=node.context)
    node.create_timer(1.0 / options.rate_hz, send, clock=clock)
    wait_for(node, lambda: bool(limit) and count >= limit)
    # Time to send the last message and for late subscriptions to match.
    wait_for(node, lambda: False, options.keep_alive_s)


def _typed(options: PublishOptions) -> list[Any]:
    """Return the parsed YAML of each message."""
    if options.yaml_file is not None:
        return from_yaml_file(options.yaml_file)
    return [from_yaml(from_stdin() if options.stdin else options.values)]


def filled_message(cls: Any, values: Any) -> tuple[Any, list[Stamp]]:
    """Return the message and the functions that stamp it before each publication.

    Raises:
        InvalidValueError: unknown field, or a value of the wrong type.
    """
    fields = get_message_spec(type_name(cls)).fields
    if values is not None and not isinstance(values, dict):
        values = {_only_field(type_name(cls), fields, values): values}
    message = cls()
    stamps: list[Stamp] = set_message_fields(
        message, values or {}, expand_header_auto=True, expand_time_now=True
    )
    return message, stamps


def _only_field(name: str, fields: tuple[Field, ...], value: Any) -> str:
    """Return the name of the only field: a bare value sets it, as with rostopic."""
    if len(fields) != 1:
        listed = ", ".join(each.name for each in fields) or "none"
        raise InvalidValueError(
            f"{shortened(value)}: {name} needs its fields by name, as in "
            f"'{{{fields[0].name if fields else ''}: …}}'; its fields are {listed}"
        )
    return fields[0].name


def _wait_for_subscriptions(
    node: Node, publisher: Publisher[Any], options: PublishOptions
) -> None:
    wanted = options.subscriptions_wanted

    def enough() -> bool:
        return publisher.get_subscription_count() >= wanted

    if enough():
        return
    note(f"waiting for {wanted} matching subscription(s){_hint(node, publisher)}")
    if not wait_for(node, enough, options.max_wait_s):
        fail(
            f"{publisher.get_subscription_count()} of {wanted} subscriptions "
            f"to {publisher.topic_name} matched in {options.max_wait_s:g} s"
        )


def _hint(node: Node, publisher: Publisher[Any]) -> str:
    """Explain missing subscriptions: incompatible QoS or a mistyped name."""
    subscribed = [e.topic for e in endpoints(node, kind=EndpointKind.SUBSCRIPTION)]
    count = subscribed.count(publisher.topic_name)
    incompatible = count - publisher.get_subscription_count()
    if incompatible:
        return f"; {incompatible} of {publisher.topic_name} have incompatible QoS"
    return "" if count else did_you_mean(publisher.topic_name, subscribed)


def _shown(message: Any) -> str:
    return shortened(message, _LONGEST_ON_TERMINAL) if is_terminal() else repr(message)
