"""Broadband self-noise by Brooks, Pope and Marcolini: one airfoil or a whole rotor."""
