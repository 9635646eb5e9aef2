"""Captions and failures of figures, in the log of their job; failures are listed in a file too.

That is empty without any, and the job goes on: other figures stay, and the rule `all_drawn` ends
the study with the list.
"""

from pathlib import Path

from fractalcontact.core.atomic import atomic_write


def say_drawn(drawn, undrawn, folder, log):
    """Say how figures were drawn, and list those that were not."""
    if drawn.unchanged:
        log.info("unchanged: %s", ", ".join(drawn.unchanged))
    for name, caption in drawn.captions.items():
        log.info("%s: %s", name, caption)
    for name, trace in drawn.failures.items():
        log.error("error in the program: figure %s was not drawn\n%s", name, trace)
    with atomic_write(undrawn) as path:
        text = "".join(f"{folder}{name}\n" for name in drawn.failures)
        Path(path).write_text(text, encoding="utf-8")
