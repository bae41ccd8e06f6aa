"""Velocities that vortex segments and filaments induce."""
