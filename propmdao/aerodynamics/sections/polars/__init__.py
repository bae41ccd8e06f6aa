"""Section polars: lift, drag and moment at all angles, over Reynolds number and Mach number."""
