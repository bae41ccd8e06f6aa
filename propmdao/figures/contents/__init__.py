"""Pictures without a drawing library: values, their names and colours."""
