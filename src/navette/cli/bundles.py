"""Commands with many options: a dataclass declares them, field by field.

::

    @dataclass(frozen=True, kw_only=True)
    class EchoOptions:
        topic: TopicName
        once: Annotated[bool, typer.Option("--once")] = False
        qos: QosWishes = field(default_factory=QosWishes)  # a bundle of its own

    def echo(options: EchoOptions) -> None: …

    topic.command()(unbundled(echo))
"""

import inspect
from collections.abc import Callable, Iterator
from dataclasses import MISSING, Field, fields, is_dataclass
from typing import Any, get_type_hints


def unbundled(command: Callable[..., None]) -> Callable[..., None]:
    """The command as Typer wants it: every field of its dataclasses is a parameter."""
    given = inspect.signature(command, eval_str=True).parameters
    bundles = {n: p.annotation for n, p in given.items() if is_dataclass(p.annotation)}
    spread: list[inspect.Parameter] = []
    for name, parameter in given.items():
        if name in bundles:
            spread += _parameters(bundles[name])
        else:
            spread.append(parameter.replace(kind=inspect.Parameter.KEYWORD_ONLY))

    def run(**values: Any) -> None:
        made = {name: _made(bundle, values) for name, bundle in bundles.items()}
        command(**made, **values)

    for name in ("__name__", "__qualname__", "__module__", "__doc__"):
        setattr(run, name, getattr(command, name))
    run.__annotations__ = {each.name: each.annotation for each in spread}
    vars(run)["__signature__"] = inspect.Signature(spread)
    return run


def _parameters(bundle: Any) -> Iterator[inspect.Parameter]:
    for each, annotation in _fields(bundle):
        if is_dataclass(annotation):
            yield from _parameters(annotation)
        else:
            yield inspect.Parameter(
                each.name,
                inspect.Parameter.KEYWORD_ONLY,
                default=inspect.Parameter.empty
                if each.default is MISSING
                else each.default,
                annotation=annotation,
            )


def _made(bundle: Any, values: dict[str, Any]) -> Any:
    """The dataclass; takes out of ``values`` what it needs."""
    return bundle(
        **{
            each.name: _made(annotation, values)
            if is_dataclass(annotation)
            else values.pop(each.name)
            for each, annotation in _fields(bundle)
        }
    )


def _fields(bundle: Any) -> list[tuple[Field[Any], Any]]:
    hints = get_type_hints(bundle, include_extras=True)
    return [(each, hints[each.name]) for each in fields(bundle)]
