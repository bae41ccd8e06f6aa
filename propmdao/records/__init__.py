"""Records that travel between the rooms, the table of quantities, units."""
