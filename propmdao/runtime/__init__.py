"""Ground that the program runs on: JAX and its settings, compiled code, worker processes."""
