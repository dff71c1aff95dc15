"""Keeps modules running: starts them in order, ends them in the opposite one."""

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from navette.errors import UnknownNameError
from navette.runtime.loop import EventLoop
from navette.supervisor import Keeper
from navette.supervisor.log_book import LogBook
from navette.supervisor.specs import ModuleSpec, State
from navette.supervisor.supervised import Supervised


class Module:
    """A module that is up, comes up or goes down."""

    def __init__(self, spec: ModuleSpec, environ: Mapping[str, str]) -> None:
        self.spec = spec
        self.environ = environ
        self.is_wanted = True
        self.has_begun = False
        self.processes: list[Supervised] = []

    @property
    def is_ready(self) -> bool:
        return self.has_begun and all(each.is_ready for each in self.processes)

    @property
    def is_alive(self) -> bool:
        return any(each.is_alive for each in self.processes)


class Supervisor:
    """All modules of a project; everything here happens on the loop.

    Args:
        on_idle: called whenever no module is left.
    """

    def __init__(
        self,
        keeper: Keeper,
        loop: EventLoop,
        log: LogBook,
        on_idle: Callable[[], None],
    ) -> None:
        self._keeper = keeper
        self._loop = loop
        self._log = log
        self._on_idle = on_idle
        self._modules: dict[str, Module] = {}
        self._looks = False

    @property
    def is_idle(self) -> bool:
        return not self._modules

    def up(self, specs: Iterable[ModuleSpec], environ: Mapping[str, str]) -> None:
        """Start modules. Of those that run, what ended starts again; one that is now
        to be something else is restarted.
        """
        for spec in specs:
            module = self._modules.get(spec.name)
            if module is None:
                self._add(spec, environ)
            elif module.spec != spec or not module.is_wanted:
                self._replace(module, spec, environ)
            else:
                for each in module.processes:
                    if each.state in (State.STOPPED, State.ENDED, State.FAILED):
                        each.start()
        self._look()

    def restart(self, specs: Iterable[ModuleSpec], environ: Mapping[str, str]) -> None:
        """End modules that run, and start them, perhaps as something else."""
        for spec in specs:
            module = self._modules.get(spec.name)
            if module is None:
                self._add(spec, environ)
            else:
                self._replace(module, spec, environ)
        self._look()

    def down(self, names: Iterable[str] | None = None) -> None:
        """End modules (all, if None), those that need others first.

        Raises:
            UnknownNameError: one that is not up; lists those that are.
        """
        wanted = list(self._modules) if names is None else list(names)
        for name in wanted:
            if name not in self._modules:
                up = ", ".join(self._modules) or "nothing"
                raise UnknownNameError(f"{name!r} is not up (up: {up})")
        for name in wanted:
            self._modules[name].is_wanted = False
        self._look()

    def status(self) -> list[dict[str, Any]]:
        """All modules with their processes; plain values."""
        return [self._status(module) for module in self._modules.values()]

    # -- inside --------------------------------------------------------------------

    def _status(self, module: Module) -> dict[str, Any]:
        processes = [each.status() for each in module.processes]
        missing = [name for name in module.spec.needs if not self._is_ready(name)]
        for process in processes:
            if process["state"] == State.WAITING.value and missing:
                process["reason"] = f"for {', '.join(missing)}"
        return {
            "module": module.spec.name,
            "wanted": module.is_wanted,
            "processes": processes,
        }

    def _add(self, spec: ModuleSpec, environ: Mapping[str, str]) -> None:
        module = self._modules[spec.name] = Module(spec, environ)
        self._fill(module)

    def _fill(self, module: Module) -> None:
        module.has_begun = False
        module.processes = [
            Supervised(
                spec,
                module.environ,
                self._keeper,
                self._loop,
                self._log,
                self._look_soon,
            )
            for spec in module.spec.processes
        ]

    def _replace(
        self, module: Module, spec: ModuleSpec, environ: Mapping[str, str]
    ) -> None:
        """End what runs of it; what is there then starts."""
        module.spec, module.environ = spec, environ
        module.is_wanted = True
        module.has_begun = False
        for each in module.processes:
            each.stop()

    def _look_soon(self) -> None:
        if not self._looks:
            self._looks = True
            self._loop.call_soon(self._look, "supervisor")

    def _look(self) -> None:
        """Do what can be done now."""
        self._looks = False
        for module in tuple(self._modules.values()):
            if module.is_wanted:
                self._begin_if_ready(module)
            else:
                self._end_if_free(module)
        if not self._modules:
            self._on_idle()

    def _begin_if_ready(self, module: Module) -> None:
        if module.has_begun or module.is_alive:
            return
        if all(map(self._is_ready, module.spec.needs)):
            self._fill(module)
            module.has_begun = True
            for each in module.processes:
                each.start()

    def _is_ready(self, name: str) -> bool:
        """Whether a module need not be waited for (as one that is not to be up)."""
        module = self._modules.get(name)
        return module is None or not module.is_wanted or module.is_ready

    def _end_if_free(self, module: Module) -> None:
        name = module.spec.name
        others = self._modules.values()
        if any(name in o.spec.needs and not o.is_wanted for o in others):
            return
        for each in module.processes:
            each.stop()
        if not module.is_alive:
            del self._modules[name]
            self._look_soon()
