"""Localizer: the estimated pose under the names that Nav2's programs use."""

from navette.navigation.localization.localizer.params import LocalizerParams

__all__ = ["LocalizerParams"]
