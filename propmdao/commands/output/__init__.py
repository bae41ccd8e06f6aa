"""Files and lines that commands write, and the folder of results."""
