"""How sources and observers move, and when what is emitted is heard."""
