"""What there is: the catalogue, this installation, words for the shell."""
