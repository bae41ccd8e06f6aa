"""The wake: momentum theory, the law of its transport, the ages of its nodes."""
