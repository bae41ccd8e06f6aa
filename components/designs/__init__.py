"""Design problems: a described propeller, what is free of it, what is minimised and limited."""
