"""Robot navigation that you pip install."""
