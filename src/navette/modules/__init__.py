"""Modules: parts of a robot's software, each some processes, kept running."""

from navette.modules.specs import ModuleSpec, ProcessSpec, RestartPolicy

__all__ = ["ModuleSpec", "ProcessSpec", "RestartPolicy"]
