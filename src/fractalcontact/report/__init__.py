"""Published numbers of a specimen: one register, one reader."""
