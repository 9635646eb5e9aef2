"""Contact states of a joint: the solve plan, the solves, their numbers and errors."""
