"""What figures share: the drawing and its files, ticks, words, maps, tables."""
