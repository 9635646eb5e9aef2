"""Limits of the solver's input and results, each defined once."""

#: Contact of fewer nodes is not resolved and not fitted: one node more changes it by 10 %.
RESOLVED_NODES = 10
#: Range of the lengths, pressures and forces of the input: products and ratios of two of them, and
#: sums over a grid, then neither overflow nor underflow.
MIN_INPUT, MAX_INPUT = 1e-150, 1e150
#: Range of the results. Within it they keep all digits: numbers below 2e-308 lose some, and there
#: are none beyond 2e308.
MIN_RESULT, MAX_RESULT = 1e-300, 1e300
