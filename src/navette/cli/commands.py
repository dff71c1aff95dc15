"""Commands of the command line: declared by annotations, imported when they run."""

from collections.abc import Callable
from importlib import import_module
from typing import Any

import click

from navette.cli.arguments import spread_lists
from navette.cli.gc_tuning import collect
from navette.cli.interruption import INTERRUPTED, raise_at_interrupt
from navette.cli.options import PanelOption, call_arguments, click_parameters

Verb = Callable[..., Any]
"""The function of a command, with annotated parameters."""


class AnnotatedCommand(click.Command):
    """A command whose parameters are the annotated parameters of its function.

    Args:
        panel: heading of the command in its group's help.
        imports_in_call: the function imports the stack, and calls
            :func:`~navette.cli.gc_tuning.collect` when all nodes exist.
    """

    def __init__(
        self,
        name: str | None = None,
        *,
        callback: Verb | None = None,
        params: list[click.Parameter] | None = None,
        panel: str = "Commands",
        imports_in_call: bool = False,
        **attributes: Any,
    ) -> None:
        if callback is not None:
            function = callback
            params = [*click_parameters(function), *(params or ())]

            def callback(**values: Any) -> Any:
                return function(**call_arguments(function, values))

        super().__init__(name, callback=callback, params=params, **attributes)
        self.panel = panel
        self.imports_in_call = imports_in_call

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        lists = {
            flag
            for each in self.params
            if isinstance(each, PanelOption) and each.takes_words
            for flag in each.opts
        }
        return super().parse_args(ctx, spread_lists(args, lists))

    def get_help(self, ctx: click.Context) -> str:
        from navette.cli.help_page import help_page

        return help_page(self, ctx)


class Group(AnnotatedCommand, click.Group):
    """A group that lists its commands in the order in which they were added."""

    command_class = AnnotatedCommand

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(self.commands)


class LazyCommand(click.Command):
    """A command or group whose module is imported when it is called.

    Importing all verbs would take longer than most of them run.

    Args:
        target: ``module:attribute`` of the function, command or group.
        help: first line of its help.
        panel: heading of the command in its group's help.
        read_only: Ctrl-C may end the process at any time until the verb connects.
        settings: click's context settings.
    """

    def __init__(
        self,
        name: str,
        target: str,
        help: str,
        *,
        panel: str,
        read_only: bool = False,
        settings: dict[str, Any] | None = None,
    ) -> None:
        super().__init__(name, help=help, context_settings=settings)
        self.panel = panel
        self.read_only = read_only
        self._target = target

    def load(self) -> click.Command:
        module, _, attribute = self._target.partition(":")
        target = getattr(import_module(module), attribute)
        if isinstance(target, click.Command):
            return target
        return click.command(
            self.name, cls=AnnotatedCommand, context_settings=self.context_settings
        )(target)


class LazyGroup(Group):
    """A group that can contain lazy commands."""

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        name, command, rest = super().resolve_command(ctx, args)
        read_only = isinstance(command, LazyCommand) and command.read_only
        if isinstance(command, LazyCommand):
            command = command.load()
        if not read_only:
            raise_at_interrupt()
            if not (isinstance(command, AnnotatedCommand) and command.imports_in_call):
                collect()
        return name, command, rest

    def invoke(self, ctx: click.Context) -> Any:
        try:
            return super().invoke(ctx)
        except KeyboardInterrupt:
            raise click.exceptions.Exit(INTERRUPTED) from None
