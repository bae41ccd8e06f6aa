"""PSU-WOPWOP cases: those of other codes, run by ours, and ours, written for it."""
