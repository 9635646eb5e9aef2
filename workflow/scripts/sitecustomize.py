"""Hands a job over before its interpreter has imported anything, Snakemake's own modules first.

Python imports a module of this name whenever it starts; `run.py` puts this folder where it looks.
"""

import sys

if "/.snakemake/scripts/" in sys.argv[0]:
    import _warm

    _warm.hand_over()
