"""Files of other programs that draw, design or analyse propellers."""
