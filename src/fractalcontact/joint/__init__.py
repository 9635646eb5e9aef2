"""The joint: faces slid against each other, their composite topography, and JRC."""
