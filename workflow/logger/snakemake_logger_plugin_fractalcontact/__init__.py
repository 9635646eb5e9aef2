"""What Snakemake does, as one line of JSON an event, for the terminal that workflow/run.py writes.

A logger plugin, which Snakemake finds by the name of its package on the path that workflow/run.py
gives it; Snakemake's own log in .snakemake/log keeps everything.
"""

import json
import os

from snakemake_interface_common.exceptions import WorkflowError
from snakemake_interface_logger_plugins.base import LogHandlerBase

#: Environment variable with the number of the file descriptor that events go to.
EVENTS = "FRACTALCONTACT_EVENTS"
#: What is passed on of an event, beside its kind, level and text.
_KEYS = ("stats", "jobid", "jobs", "job_id", "rule_name", "rule_msg", "reason", "log")


class LogHandler(LogHandlerBase):
    """Writes events to the pipe of the process that started Snakemake."""

    def __post_init__(self):
        """Open the pipe."""
        number = os.environ.pop(EVENTS, None)  # jobs have no such file
        if number is None:
            raise WorkflowError("--logger fractalcontact is for workflow/run.py, which 'make' runs")
        self.pipe = os.fdopen(int(number), "w", encoding="utf-8", errors="backslashreplace")

    def emit(self, record):
        """Pass on one event."""
        event = getattr(record, "event", None)
        told = {"event": event and str(event), "level": record.levelname, "text": str(record.msg)}
        found = {key: getattr(record, key) for key in _KEYS if hasattr(record, key)}
        try:
            self.pipe.write(json.dumps(told | found, default=str) + "\n")
            self.pipe.flush()
        except BrokenPipeError:  # whoever listened has ended, and ends this process too
            pass

    @property
    def writes_to_stream(self) -> bool:
        """In place of what Snakemake writes to the terminal."""
        return True

    @property
    def writes_to_file(self) -> bool:
        """No file of its own."""
        return False

    @property
    def has_filter(self) -> bool:
        """Whoever reads the events chooses among them."""
        return True

    @property
    def has_formatter(self) -> bool:
        """Records are written as they are."""
        return True

    @property
    def needs_rulegraph(self) -> bool:
        """Jobs suffice."""
        return False
