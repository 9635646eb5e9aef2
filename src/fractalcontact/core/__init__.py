"""What every room uses: errors, units, intervals, line fits, files that appear whole."""
