"""``navette doctor``: what is wrong, and what to do about it."""

from navette.cli.doctor.command import doctor

__all__ = ["doctor"]
