"""``navette param …``: the parameters of nodes that run."""

from navette.cli.param.verbs import param

__all__ = ["param"]
