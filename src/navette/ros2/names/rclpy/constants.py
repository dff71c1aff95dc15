"""Numbers."""

from navette.runtime.time import NS_PER_S as S_TO_NS

__all__ = ["S_TO_NS"]
