"""``navette param``: parameters of running nodes."""

from navette.cli.param.verbs import param

__all__ = ["param"]
