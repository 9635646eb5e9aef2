"""What a job of figures says of them: captions to its log, failures to a file of their own."""

from fractalcontact.core.atomic import atomic_write


def report(drawn, specimen, path, log):
    """Log captions and failures, and list the failures in a file, which is empty without any.

    The job itself goes on: its other figures stay, and those of other specimens. The rule
    `all_drawn` then ends the study with the list.

    Parameters
    ----------
    drawn : fractalcontact.figures.draw.Drawn or None
        None where nothing was to be drawn.
    specimen : str
        Empty for figures of the whole study.
    path : str
    log : logging.Logger
    """
    captions, failures = (drawn.captions, drawn.failures) if drawn else ({}, {})
    for name, caption in captions.items():
        log.info("%s: %s", name, caption)
    for name, trace in failures.items():
        log.error("error in the program: figure %s was not drawn\n%s", name, trace)
    with atomic_write(path) as file:
        file.write_text("".join(f"{specimen}/{name}\n".lstrip("/") for name in failures))
