"""Files of QBlade: blades, with the polars and contours of their sections."""
