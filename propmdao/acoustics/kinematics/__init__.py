"""Motion of sources and observers, and the times at which sound is emitted and heard."""
