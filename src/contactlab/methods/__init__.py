"""Other solvers of the same contact problem, for comparison only."""
