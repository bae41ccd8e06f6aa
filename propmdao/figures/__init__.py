"""Every picture, a module for each kind."""
