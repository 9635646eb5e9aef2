"""Results of which Snakemake has lost the record of how they were made: they are made again.

Snakemake compares the parameters and inputs of a file with its record. It takes a file for up to
date whose record is lost or unreadable, and one that was made from a result that has since been
removed, even if the job of that result failed after its scan was replaced. And where the job of a
file that is flagged `update` fails, it puts the file of before back, and records it as made by that
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


def mark_without_provenance(results, settings):
    """Number of such results, which are marked as incomplete, as those of killed jobs are."""
    if settings.persistence_backend is PersistenceBackend.DB:
        records = DbPersistence(db_url=settings.persistence_backend_db_url)
    else:
        records = FilePersistence()
    is_there = functools.cache(lambda path: Path(path).exists())
    files = [IOFile(f"{results}/{line[66:].rstrip()}") for line in checksums.lines_of(results)]
    # Snakemake would warn of each damaged record, by a name in base64.
    logging.disable(logging.WARNING)
    lacking = [file for file in files if not _has_provenance(file, records, results, is_there)]
    logging.disable(logging.NOTSET)
    for file in lacking:
        records.cleanup_metadata(file)  # Snakemake itself stumbles over some that are damaged
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
    """True of a file whose job, the last of Snakemake's record, failed: it has left no checksums.

    Both times are younger than the checksums then; in a copy of a folder neither need be in order.
    """
    left = os.stat(sums).st_mtime
    return (record.starttime or 0) > left and os.stat(file).st_mtime > left
