"""The blade as a slender beam that twists and bends under its loads."""
