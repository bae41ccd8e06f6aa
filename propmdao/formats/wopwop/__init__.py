"""Files of PSU-WOPWOP: reading and writing its cases."""
