"""Sound on its way to the observer: absorption by air, reflection by ground."""
