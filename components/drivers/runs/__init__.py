"""How drivers run the model: one design or many, here, in worker processes or in batches."""
