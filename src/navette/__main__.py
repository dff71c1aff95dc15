"""``python -m navette`` is ``navette``."""

from navette.cli import main

if __name__ == "__main__":
    main()
