"""Pictures of the flow: loads over the disk, wakes, sections."""
