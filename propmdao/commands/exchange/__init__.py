"""Files for other programs and from them: ``propmdao export`` and ``wopwop``."""
