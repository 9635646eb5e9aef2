"""Tools shared by figures: the drawing and its files, ticks, words, maps, tables."""
