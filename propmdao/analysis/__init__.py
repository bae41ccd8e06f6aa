"""Where the disciplines meet: from a described propeller to loads and noise."""
