"""How drivers evaluate designs: one or many, here, in worker processes or in batches."""
