"""What components are built on: a compiled function, operating points, a root."""
