"""What travels between the rooms: records, the table of quantities, units."""
