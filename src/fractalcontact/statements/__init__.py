"""What the paper states, compared with the atlas of a study."""
