"""Supervisor: starts services in order of dependency, stops them in reverse order."""

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from navette.errors import UnknownNameError
from navette.runtime.loop import EventLoop
from navette.supervisor.log_store import LogStore
from navette.supervisor.process_manager import ProcessManager
from navette.supervisor.service_config import ProcessState, ServiceConfig
from navette.supervisor.service_process import ServiceProcess

_OVER = (ProcessState.STOPPED, ProcessState.ENDED, ProcessState.FAILED)


class ManagedService:
    """A service that is up, starting or stopping."""

    def __init__(self, spec: ServiceConfig, environ: Mapping[str, str]) -> None:
        self.spec = spec
        self.environ = environ
        self.should_run = True
        self.is_started = False
        self.processes: list[ServiceProcess] = []

    @property
    def is_ready(self) -> bool:
        return self.is_started and all(each.is_ready for each in self.processes)

    @property
    def is_alive(self) -> bool:
        return any(each.is_alive for each in self.processes)


OnIdle = Callable[[], None]
"""Called whenever no service is left."""


class Supervisor:
    """All services of a project; all methods run on the loop."""

    def __init__(
        self,
        manager: ProcessManager,
        loop: EventLoop,
        log: LogStore,
        *,
        on_idle: OnIdle,
    ) -> None:
        self._manager = manager
        self._loop = loop
        self._log = log
        self._on_idle = on_idle
        self._services: dict[str, ManagedService] = {}
        self._reconcile_pending = False

    @property
    def is_idle(self) -> bool:
        return not self._services

    def up(self, specs: Iterable[ServiceConfig], environ: Mapping[str, str]) -> None:
        """Start services.

        Ended processes of a running service start again; a service whose spec has
        changed is restarted.
        """
        for spec in specs:
            service = self._services.get(spec.name)
            if service is None or service.spec != spec or not service.should_run:
                self._replace(spec, environ)
                continue
            for process in service.processes:
                if process.state in _OVER:
                    process.start()
        self._reconcile()

    def restart(
        self, specs: Iterable[ServiceConfig], environ: Mapping[str, str]
    ) -> None:
        """Stop services that run and start them with the given specs."""
        for spec in specs:
            self._replace(spec, environ)
        self._reconcile()

    def down(self, names: Iterable[str] | None = None) -> None:
        """Stop services (all, if None), dependents first.

        Raises:
            UnknownNameError: a service that is not up; lists the services that are.
        """
        chosen = list(self._services) if names is None else list(names)
        for name in chosen:
            if name not in self._services:
                up = ", ".join(self._services) or "nothing"
                raise UnknownNameError(f"{name!r} is not up (up: {up})")
        for name in chosen:
            self._services[name].should_run = False
        self._reconcile()

    def status(self) -> list[dict[str, Any]]:
        """Return all services with their processes as JSON values."""
        return [self._status(service) for service in self._services.values()]

    def _status(self, service: ManagedService) -> dict[str, Any]:
        processes = [each.status() for each in service.processes]
        missing = [name for name in service.spec.depends_on if self._blocks(name)]
        for process in processes:
            if process["state"] == ProcessState.WAITING.value and missing:
                process["reason"] = f"for {', '.join(missing)}"
        return {"service": service.spec.name, "processes": processes}

    def _replace(self, spec: ServiceConfig, environ: Mapping[str, str]) -> None:
        """Set what a service is to run; its present processes stop."""
        service = self._services.get(spec.name)
        if service is None:
            service = self._services[spec.name] = ManagedService(spec, environ)
            self._create_processes(service)
            return
        service.spec, service.environ = spec, environ
        service.should_run = True
        service.is_started = False
        for process in service.processes:
            process.stop()

    def _create_processes(self, service: ManagedService) -> None:
        service.processes = [
            ServiceProcess(
                spec,
                service.environ,
                manager=self._manager,
                loop=self._loop,
                log=self._log,
                on_change=self._reconcile_soon,
            )
            for spec in service.spec.processes
        ]

    def _reconcile_soon(self) -> None:
        if not self._reconcile_pending:
            self._reconcile_pending = True
            self._loop.call_soon(self._reconcile, "supervisor")

    def _reconcile(self) -> None:
        """Start and stop the services that can be started and stopped now."""
        self._reconcile_pending = False
        for service in tuple(self._services.values()):
            if service.should_run:
                self._start_if_possible(service)
            else:
                self._stop_if_possible(service)
        if not self._services:
            self._on_idle()

    def _start_if_possible(self, service: ManagedService) -> None:
        if service.is_started or service.is_alive:
            return
        if not any(map(self._blocks, service.spec.depends_on)):
            self._create_processes(service)
            service.is_started = True
            for process in service.processes:
                process.start()

    def _blocks(self, name: str) -> bool:
        """Return whether dependents of a service must wait for it."""
        service = self._services.get(name)
        return service is not None and service.should_run and not service.is_ready

    def _stop_if_possible(self, service: ManagedService) -> None:
        name = service.spec.name
        others = self._services.values()
        if any(name in o.spec.depends_on and not o.should_run for o in others):
            return
        for process in service.processes:
            process.stop()
        if not service.is_alive:
            del self._services[name]
            self._reconcile_soon()
