"""The joint: closure, dilatancy, real contact area and strength from its contact states."""
