"""What a user sets: parameters of stages; methods by name are in ``plugins``."""

from navette.params.fields import LARGEST, ParamInfo, Params, info_of, param

__all__ = ["LARGEST", "ParamInfo", "Params", "info_of", "param"]
