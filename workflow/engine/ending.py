"""SIGTERM answered in a thread, so that a run told to end does end.

Snakemake 9.27 answers the signal in its main thread, with a lock that is not reentrant
(``JobScheduler.exit_gracefully``). The main thread may hold that lock, as it does while it takes in
finished jobs; the run then waits for itself for ever. A thread waits until the lock is free. Jobs
that have not begun do not begin any more. The cost is nothing until a run is told to end. To do
without, leave ``answer_in_thread`` out of ``begin`` in ``workflow/rules/records.smk``.
"""

import signal
import threading

#: Event that is set when this run is told to end.
TOLD = threading.Event()


def answer_in_thread(number: int = signal.SIGTERM) -> None:
    """Let a thread answer a signal as the main thread would. The main thread must call this."""
    answer = signal.getsignal(number)

    def begin_answer(*told):
        threading.Thread(target=_answer, args=(answer, told)).start()

    if callable(answer):
        signal.signal(number, begin_answer)


def _answer(answer, told):
    TOLD.set()  # set in this thread, because the event has such a lock too
    answer(*told)
