"""One coarse mesh for the tests that compile much: they share what is compiled for it."""

from propmdao.records.fidelity import Fidelity

#: That of the numbers kept in tests/regression.
COARSE = Fidelity(n_chordwise=4, n_spanwise=8, n_contour=21, n_surface_span=16, n_harmonics=5)
