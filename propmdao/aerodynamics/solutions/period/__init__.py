"""The period of a rotor at an incidence: its lattice, its loads, and where its search begins."""
