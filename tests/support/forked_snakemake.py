"""Dry runs of Snakemake as forks of one process: to load it takes two fifths of each."""

import functools
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

#: Process that forks: it is given a run as a line of JSON, and answers with the run's exit code.
SERVER = """
import json, os, sys
import pandas  # Snakemake imports it when it compares parameters
from snakemake import cli

cli.get_argument_parser()  # loads the plugins
for line in sys.stdin:
    words, folder, files, environment = json.loads(line)
    child = os.fork()
    if not child:
        os.chdir(folder)
        os.environ.clear()
        os.environ.update(environment)
        for number, file in enumerate(files):
            os.dup2(os.open(file, os.O_RDWR), number)
        sys.argv = ["snakemake", *words]
        sys.exit(cli.main())
    print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)
"""


@functools.cache
def _server():
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
    return subprocess.Popen([sys.executable, "-c", SERVER], **pipes)


def dry_run(folder, *words):
    """What ``python -m snakemake WORDS`` says in a folder, as ``subprocess.run`` returns it."""
    with tempfile.TemporaryDirectory() as files:
        out, err = Path(files, "out"), Path(files, "err")
        for path in (out, err):
            path.touch()
        given = [os.devnull, str(out), str(err)]
        print(json.dumps([words, str(folder), given, dict(os.environ)]), file=_server().stdin)
        _server().stdin.flush()
        code = int(_server().stdout.readline())
        said = (path.read_text(encoding="utf-8") for path in (out, err))
        return subprocess.CompletedProcess(words, code, *said)
