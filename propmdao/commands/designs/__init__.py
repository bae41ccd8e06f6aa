"""Designs beside each other and searches for them: ``propmdao compare`` and ``optimise``."""
