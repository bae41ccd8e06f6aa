"""Flight in time: marches of a rotor, flights over an observer and what is heard of them."""
