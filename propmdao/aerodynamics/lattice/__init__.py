"""The vortex lattice of a blade: rings and the strips they form."""
