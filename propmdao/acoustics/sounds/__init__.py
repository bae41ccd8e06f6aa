"""Records of pressure to listen to."""
