"""Fixed limits of the solver's input and results, each once."""

#: Contact of fewer nodes is not resolved, and not fitted: one node more or less is 10 % of it.
RESOLVED_NODES = 10
#: Lengths, pressures and forces a computation starts from lie between these: products and ratios
#: of two of them, and sums over a grid, then neither over- nor underflow.
MIN_INPUT, MAX_INPUT = 1e-150, 1e150
#: And whatever a computation works out of them between these, so that its last digits are digits:
#: below 2e-308 numbers lose them, beyond 2e308 there are none.
MIN_RESULT, MAX_RESULT = 1e-300, 1e300
