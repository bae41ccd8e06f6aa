"""A blade that gives under its loads: its material, and loads and shape that belong together."""
