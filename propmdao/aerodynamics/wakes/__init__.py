"""Where the wake goes: momentum theory, its law of transport, the ages of its nodes."""
