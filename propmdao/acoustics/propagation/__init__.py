"""What the way to the observer does to sound: absorption by air, reflection by ground."""
