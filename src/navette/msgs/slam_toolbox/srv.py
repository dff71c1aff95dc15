"""Services of slam_toolbox, made on first use."""

# Written by python -m navette.msgs.generate; do not edit.
from navette.msgs.lazy import module_contents

__getattr__, __dir__, __all__ = module_contents(globals())
