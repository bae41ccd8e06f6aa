"""Make the polar tables of the catalogue; needs the extra `polars`.

    python tools/generate_polars.py [FILE]

The file records NeuralFoil's version and settings; the tables that ship are described by
`propmdao.aerodynamics.sections.polars.shipped.shipped_settings()`.
"""

from __future__ import annotations

import sys
from pathlib import Path

from propmdao.aerodynamics.sections.polars.neuralfoil_tables import (
    neuralfoil_installed,
    neuralfoil_settings,
)
from propmdao.aerodynamics.sections.polars.shipped import generate

DEFAULT = (
    Path(__file__).parents[1] / "propmdao" / "propeller" / "catalog" / "polars" / "sections.npz"
)

if __name__ == "__main__":
    if not neuralfoil_installed():
        sys.exit(
            "the tables are made by NeuralFoil, which is missing: pip install 'propmdao[polars]'"
        )
    path = Path(sys.argv[1]) if len(sys.argv) > 1 else DEFAULT
    generate(path)
    print(f"{path} ({path.stat().st_size} bytes): {neuralfoil_settings()}")
