"""``python -m navette.cli``: the command, for whoever starts it as a process."""

from navette.cli import main

if __name__ == "__main__":
    main()
