"""Base classes of the components: around a compiled function, at many points, at a root."""
