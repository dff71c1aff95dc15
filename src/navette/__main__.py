"""``python -m navette`` is ``navette``."""

from navette.cli import main

main()
