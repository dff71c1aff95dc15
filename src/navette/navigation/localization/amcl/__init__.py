"""Adaptive Monte Carlo localization in a known map."""

from navette.navigation.localization.amcl.likelihood_field import LikelihoodField
from navette.navigation.localization.amcl.params import AmclParams
from navette.navigation.localization.amcl.particle_filter import ParticleFilter

__all__ = ["AmclParams", "LikelihoodField", "ParticleFilter"]
