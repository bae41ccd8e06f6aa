"""A propeller at many points: the points, and the table of their results."""
