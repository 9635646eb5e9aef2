"""The elastic half-space: normal displacement under a pressure, by fast Fourier transforms."""
