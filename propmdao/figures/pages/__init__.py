"""Pages to read, hear and turn around in a browser: one HTML file each that needs nothing else."""
