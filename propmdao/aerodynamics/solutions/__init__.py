"""Solutions of the lattice in its wake, and their results."""
