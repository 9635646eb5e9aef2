"""Laboratory tests of a joint beside its computed curves."""
