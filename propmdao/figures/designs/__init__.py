"""Figures of designs over each other and of searches for them."""
