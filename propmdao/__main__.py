"""The command line as ``python -m propmdao``."""

import sys

from propmdao.commands.program import main

if __name__ == "__main__":
    sys.exit(main())
