"""Fixed limits of the solver's results, each once."""

#: Contact of fewer nodes is not resolved, and not fitted: one node more or less is 10 % of it.
RESOLVED_NODES = 10
