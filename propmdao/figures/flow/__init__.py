"""Pictures of the flow: loads over the disk, wakes, blades for ParaView, results over meshes."""
