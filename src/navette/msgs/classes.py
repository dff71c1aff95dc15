"""Python classes of interfaces, made on first use.

The methods of each message class are compiled from generated source, because setters
and constructors written out per field are several times faster than generic ones.
"""

from collections.abc import Callable, Iterable
from operator import attrgetter
from typing import Any

from navette.errors import UnknownNameError
from navette.msgs.base import Message, idl_type
from navette.msgs.class_source import generate
from navette.msgs.interface import ActionSpec, MessageSpec, ServiceSpec, Spec
from navette.msgs.registration import (
    load_definition_text,
    load_private_definition,
)
from navette.msgs.registry import full_name, get_message_spec, get_spec

_classes: dict[str, type] = {}


def get_interface(name: str) -> type:
    """Return the class of ``pkg/msg/Name``, ``pkg/srv/Name`` or ``pkg/action/Name``.

    ``pkg/Name`` means a message. The same name always returns the same class.

    Raises:
        InvalidNameError: the name has the wrong form.
        UnknownNameError: no such interface; lists those of the package.
    """
    name = full_name(name)
    found = _classes.get(name)
    if found is None:
        # setdefault: two threads that make the class at once get the same one.
        found = _classes.setdefault(name, _make(get_spec(name)))
    return found


def get_message_class(name: str) -> type[Message]:
    """Return the class of a message; raises as :func:`get_interface`."""
    get_message_spec(name)
    cls = get_interface(name)
    assert issubclass(cls, Message), "a message spec makes a message class"
    return cls


def register_definition(type_name: str, text: str, *, private: bool = False) -> type:
    """Register a type from its definition and return its class.

    A registered type with the same fields (with the same RIHS01 hash) is kept, and its
    class is returned.

    Args:
        type_name: ``pkg/msg/Name`` (or ``pkg/Name``), ``pkg/srv/Name``,
            ``pkg/action/Name``.
        text: ``ros2msg`` text, with a section ``MSG: pkg/Name`` below a line of 80
            ``=`` for each contained type that is not registered.
        private: register a type that conflicts with a registered one under another
            name instead of raising: a bag may be older than the installed type.

    Raises:
        FileFormatError: the text is malformed or too large, refers to an unknown type,
            or conflicts with a registered type.
        InvalidNameError: ``type_name`` has the wrong form.
    """
    if private:
        return get_interface(load_private_definition(type_name, text))
    load_definition_text(type_name, text)
    return get_interface(type_name)


def type_name(interface: object) -> str:
    """Return the full name, ``geometry_msgs/msg/Twist``, of a class or a message.

    Raises:
        UnknownNameError: ``interface`` is neither.
    """
    name = getattr(interface, "_type_name_", None)
    if not isinstance(name, str):
        raise UnknownNameError(
            f"{interface!r} is neither a message, service or action class nor a message"
        )
    return name


def _make(spec: Spec) -> type:
    if isinstance(spec, MessageSpec):
        return _make_message(spec)
    if isinstance(spec, ServiceSpec):
        return _make_service(spec)
    return _make_action(spec)


def _make_service(spec: ServiceSpec) -> type:
    return _namespace_class(
        spec.name,
        Request=get_interface(spec.request.name),
        Response=get_interface(spec.response.name),
        Event=get_interface(spec.event.name),
    )


def _make_action(spec: ActionSpec) -> type:
    impl = type(
        "Impl",
        (),
        {
            "SendGoalService": get_interface(spec.send_goal.name),
            "GetResultService": get_interface(spec.get_result.name),
            "FeedbackMessage": get_interface(spec.feedback_message.name),
            "CancelGoalService": get_interface("action_msgs/srv/CancelGoal"),
            "GoalStatusMessage": get_interface("action_msgs/msg/GoalStatusArray"),
        },
    )
    return _namespace_class(
        spec.name,
        Goal=get_interface(spec.goal.name),
        Result=get_interface(spec.result.name),
        Feedback=get_interface(spec.feedback.name),
        Impl=impl,
    )


def _namespace_class(name: str, **members: type) -> type:
    def refuse(cls: type, *_: object, **__: object) -> Any:
        # As rosidl's classes of services and actions: they only group messages.
        raise NotImplementedError(
            f"{name} is not a message: use its {', '.join(members)} classes"
        )

    body = {"_type_name_": name, "__module__": _module_of(name), "__new__": refuse}
    return type(name.rpartition("/")[2], (), {**body, **members})


def _module_of(name: str) -> str:
    package, kind, _ = name.split("/")
    return f"navette.msgs.{package}.{kind}"


def _make_message(spec: MessageSpec) -> type[Message]:
    nested = [
        get_message_class(field.type.base) if field.type.is_message else None
        for field in spec.fields
    ]
    namespace: dict[str, Any] = {
        "__slots__": tuple(f"_{field.name}" for field in spec.fields),
        "__module__": _module_of(spec.name),
        "__doc__": f"{spec.name}: {', '.join(field.name for field in spec.fields)}",
        "__reduce__": _reduce,
        "_spec_": spec,
        "_type_name_": spec.name,
        "_field_types_": {field.name: idl_type(field.type) for field in spec.fields},
    }
    namespace |= {constant.name: constant.value for constant in spec.constants}
    cls: type[Message] = type(spec.name.rpartition("/")[2], (Message,), namespace)
    _uncompiled[cls] = nested
    _compile_on_use(cls)
    return cls


_uncompiled: dict[type[Message], list[type[Message] | None]] = {}
"""Classes that were not used yet, with the classes of their fields."""


def _compile_on_use(cls: type[Message]) -> None:
    """Add a constructor and setters that compile the real ones on their first call.

    Compiling takes 0.3 ms, and the services of a node have three classes each that most
    programs do not use.
    """

    def construct(self: Message, /, *arguments: Any, **fields: Any) -> None:
        _compile(cls)
        cls.__init__(self, *arguments, **fields)

    def make_default() -> Message:
        _compile(cls)
        made: Message = cls._make_default_()
        return made

    def setter(name: str) -> Callable[[Message, Any], None]:
        def set_field(self: Message, value: Any) -> None:
            _compile(cls)
            getattr(cls, name).__set__(self, value)

        return set_field

    _add_methods(cls, construct, make_default, map(setter, cls._field_types_))


def _compile(cls: type[Message]) -> None:
    nested = _uncompiled.get(cls)
    if nested is None:
        return
    for each in nested:
        if each is not None:
            _compile(each)  # whose makers of defaults are used as they are now
    scope = generate(cls._spec_, nested)
    scope["_cls"] = cls
    setters = (scope[f"_set_{index}"] for index in range(len(nested)))
    _add_methods(cls, scope["__init__"], scope["_make_default"], setters)
    _uncompiled.pop(cls, None)  # last: a thread that misses it here has the methods


def _add_methods(
    cls: type[Message],
    construct: Callable[..., None],
    make_default: Callable[[], Message],
    setters: Iterable[Callable[[Message, Any], None]],
) -> None:
    cls.__init__ = construct  # type: ignore[method-assign]
    cls._make_default_ = staticmethod(make_default)
    for name, set_field in zip(cls._field_types_, setters, strict=True):
        # attrgetter reads a slot at C speed; a Python getter costs half as much again.
        setattr(cls, name, property(attrgetter(f"_{name}"), set_field))


def _reduce(message: Message) -> tuple[Any, ...]:
    """Pickle by type name: the class exists only after its first use."""
    values = tuple(getattr(message, name) for name in message._field_types_)
    return _restore, (message._type_name_, values)


def _restore(name: str, values: tuple[Any, ...]) -> Message:
    cls = get_message_class(name)
    return cls(**dict(zip(cls._field_types_, values, strict=True)))
