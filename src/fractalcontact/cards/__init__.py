"""Card of a joint: its constants with intervals, for people, programs and other codes."""
