"""``navette doctor``: find problems and suggest what to do."""

from navette.cli.doctor.command import doctor

__all__ = ["doctor"]
