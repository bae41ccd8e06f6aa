"""``python -m propmdao`` is the command line."""

import sys

from propmdao.commands.program import main

sys.exit(main())
