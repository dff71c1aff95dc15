"""What a user sets: parameters of stages; methods by name are in ``plugins``."""

from navette.params.fields import (
    LARGEST,
    UNITS,
    ParamInfo,
    Params,
    info_of,
    param,
    unit_of,
)

__all__ = ["LARGEST", "UNITS", "ParamInfo", "Params", "info_of", "param", "unit_of"]
