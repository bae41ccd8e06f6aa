"""The bench: a blade that is bent by sliders in the browser, and heard."""
