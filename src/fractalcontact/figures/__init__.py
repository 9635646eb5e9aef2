"""The figures: one module each, drawn from an atlas and nothing else."""
