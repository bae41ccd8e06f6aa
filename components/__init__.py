"""OpenMDAO components, the group that connects them, and drivers."""
