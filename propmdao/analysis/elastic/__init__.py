"""Blades ready for their loads: held in their shape, or giving under them."""
