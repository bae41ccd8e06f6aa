"""Files in and out, a module for each format."""
