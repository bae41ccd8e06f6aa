"""Marching in time: loads of a rotor step by step, in a prescribed or a free wake."""
