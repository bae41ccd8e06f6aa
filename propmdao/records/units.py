"""Units that users give, in those that the program computes in."""

from __future__ import annotations

import math

#: One revolution per minute [rad/s].
RAD_PER_S = math.pi / 30.0
