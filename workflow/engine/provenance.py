"""Results whose record Snakemake has lost: they are made again.

Snakemake compares the parameters and inputs of a file with its record. It takes a file for up to
date whose record is lost or unreadable, and one that was made from a result that has since been
removed, even if the job of that result failed after its scan was replaced. And where the job of a
file that is flagged `update` fails, Snakemake restores the old file but records it as made by that
job.
"""

import functools
import logging
import os
from pathlib import Path
from types import SimpleNamespace

from snakemake.io import IOFile
from snakemake.persistence.db import DbPersistence
from snakemake.persistence.file import FilePersistence
from snakemake.settings.enums import PersistenceBackend

from fractalcontact.core import checksums

from . import running


def mark_without_provenance(results, settings):
    """Number of results without a record, which are marked as incomplete as after a killed job."""
    if settings.persistence_backend is PersistenceBackend.DB:
        records = DbPersistence(db_url=settings.persistence_backend_db_url)
    else:
        records = FilePersistence()
    is_there = functools.cache(lambda path: Path(path).exists())
    files = [IOFile(f"{results}/{line[66:].rstrip()}") for line in checksums.lines_of(results)]
    # Snakemake would warn of each damaged record, and name it in base64.
    logging.disable(logging.WARNING)
    lacking = [file for file in files if not _has_provenance(file, records, results, is_there)]
    logging.disable(logging.NOTSET)
    for file in lacking:
        records.cleanup_metadata(file)  # Snakemake itself fails on some damaged records
    records.started(SimpleNamespace(output=lacking))
    return len(lacking)


def _has_provenance(file, records, results, is_there):
    """True if the record of a file is whole and all results that it was made from exist."""
    try:
        record = records.metadata(file)
    except ValueError:  # not text, or not a record
        return False
    outdated = records.has_outdated_metadata(SimpleNamespace(output=[file]))
    if record is None or outdated or None in (record.params, record.input):
        return False
    return not _is_put_back(file, record, checksums.record_of(results, file)) and all(
        is_there(path) for path in record.input if path.startswith(f"{results}/")
    )


def _is_put_back(file, record, sums):
    """True of an old file that was restored when its job failed and so left no checksums.

    The record and the file are both younger than the checksums then, as they are after ``--touch``;
    but the last line of the job's log does not say that it is done.
    """
    left = os.stat(sums).st_mtime
    if (record.starttime or 0) <= left or os.stat(file).st_mtime <= left:
        return False
    return not any(_is_done(Path(log)) for log in record.log or ())


def _is_done(log):
    text = log.read_text(encoding="utf-8", errors="replace") if log.is_file() else ""
    return any(line.startswith(running.DONE) for line in text.splitlines()[-1:])
