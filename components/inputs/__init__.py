"""What components and groups are given: operating points, rotors, observers, options."""
