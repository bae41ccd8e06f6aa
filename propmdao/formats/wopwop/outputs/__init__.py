"""Results of PSU-WOPWOP: pressures read, levels written."""
