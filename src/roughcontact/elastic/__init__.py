"""The elastic half-space: displacement under a pressure, on a window or on nodes of it."""
