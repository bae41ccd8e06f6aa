"""What a user describes: a propeller, its checks, its airfoils, the catalogue."""
