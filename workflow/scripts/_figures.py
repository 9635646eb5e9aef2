"""Captions and failures of figures, in the log of their job; failures are listed in a file too.

That is empty without any, and the job goes on: other figures stay, and the rule `all_drawn` ends
the study with the list.
"""

from pathlib import Path

from fractalcontact.core.atomic import atomic_write


def say_drawn(drawn, undrawn, folder, log):
    """Say how figures were drawn, None of them at all, and list those that were not."""
    captions, failures = (drawn.captions, drawn.failures) if drawn else ({}, {})
    for name, caption in captions.items():
        log.info("%s: %s", name, caption)
    for name, trace in failures.items():
        log.error("error in the program: figure %s was not drawn\n%s", name, trace)
    with atomic_write(undrawn) as path:
        text = "".join(f"{folder}{name}\n" for name in failures)
        Path(path).write_text(text, encoding="utf-8")
