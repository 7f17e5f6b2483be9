"""A pool of processes that loses one task, not the run, when a process dies."""

from __future__ import annotations

import multiprocessing
import signal
from collections import deque
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager, suppress
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from typing import Any, Generic, TypeVar

Task = TypeVar("Task")
Result = TypeVar("Result")
_ENDING_SECONDS = 0.5
_READY = "ready"
_NOT_STARTED = (
    "a process to fly in could not start. Each imports the main script again: a script that flies "
    'must do so under if __name__ == "__main__", and be a file'
)


class ProcessDiedError(Exception):
    """The process that had a task in hand ended.

    Attributes:
        exit_code: the process's, negative for the signal that ended it; None if unknown.
    """

    def __init__(self, exit_code: int | None) -> None:
        super().__init__(exit_code)  # what a pickle makes it of again
        self.exit_code = exit_code

    def __str__(self) -> str:
        return f"the process ended with exit code {self.exit_code}"


class StartError(RuntimeError):
    """A process that could not even begin."""


class _Worker(Generic[Task]):
    """One process, its pipe, and the task it has in hand."""

    def __init__(self, function: Callable[[Any], Any]) -> None:
        # spawn: a fork would copy the engine's threads in whatever state they are.
        context = multiprocessing.get_context("spawn")
        self.pipe, theirs = context.Pipe()
        self.process: BaseProcess = context.Process(
            target=_serve, args=(function, theirs), daemon=True
        )
        with _interrupts_blocked():
            self.process.start()
        theirs.close()
        self.task: Task | None = None
        self._ready = False

    def receive(self) -> Any:
        """Read what the process says: ``_READY`` first, then answers.

        Raises:
            EOFError, OSError: the process is gone.
            StartError: it never began.
        """
        try:
            said = self.pipe.recv()
        except (EOFError, OSError) as error:
            if self._ready:
                raise
            self.end()
            raise StartError(_NOT_STARTED) from error
        self._ready = True
        return said

    def give(self, task: Task) -> None:
        self.task = task
        self.pipe.send(task)

    def end(self) -> None:
        self.process.terminate()
        self.process.join(_ENDING_SECONDS)
        if self.process.is_alive():
            self.process.kill()
            self.process.join()
        self.pipe.close()


class Lane(Generic[Task, Result]):
    """One process that takes a task at a time, and is replaced where it dies.

    Args:
        function: as of :func:`run_tasks`.
    """

    def __init__(self, function: Callable[[Task], Result]) -> None:
        self._function = function
        self._worker: _Worker[Task] = _Worker(function)

    def run(self, task: Task) -> Result | ProcessDiedError:
        """``function(task)``, or how the process died of it."""
        try:
            self._worker.give(task)
            while (said := self._worker.receive()) == _READY:
                pass
            return said  # type: ignore[no-any-return]
        except (EOFError, OSError):
            died = _how_it_died(self._worker)
            self._worker = _Worker(self._function)
            return died

    def end(self) -> None:
        """End the process."""
        self._worker.end()


def run_tasks(
    function: Callable[[Task], Result], tasks: Sequence[Task], workers: int
) -> Generator[tuple[Task, Result | ProcessDiedError], None, None]:
    """Yield ``(task, function(task))`` for every task, in the order in which they end.

    ``function`` is importable by name and does not raise. Where the process that runs it dies,
    the task's result is a :class:`ProcessDiedError` and a new process takes over. Leaving the
    iteration early, by Ctrl-C too, ends the processes within a second.
    """
    waiting = deque(tasks)
    pool: list[_Worker[Task]] = []
    try:
        for _ in range(min(workers, len(waiting))):
            worker: _Worker[Task] = _Worker(function)
            pool.append(worker)
            _give(worker, waiting.popleft())
        while busy := {worker.pipe: worker for worker in pool if worker.task is not None}:
            for pipe in wait(list(busy)):
                worker = busy[pipe]  # type: ignore[index]
                task = worker.task
                assert task is not None
                result: Result | ProcessDiedError
                try:
                    result = worker.receive()
                    if result == _READY:
                        continue
                except (EOFError, OSError):
                    result = _how_it_died(worker)
                    pool.remove(worker)
                    if waiting:
                        worker = _Worker(function)
                        pool.append(worker)
                worker.task = None
                if waiting and worker in pool:
                    _give(worker, waiting.popleft())
                yield task, result
    finally:
        for worker in pool:
            worker.end()


def _give(worker: _Worker[Task], task: Task) -> None:
    """Hand over a task; that a process is gone already is noticed at the next read."""
    with suppress(OSError):
        worker.give(task)


def _how_it_died(worker: _Worker[Any]) -> ProcessDiedError:
    worker.end()
    return ProcessDiedError(worker.process.exitcode)


def _serve(function: Callable[[Any], Any], pipe: Connection) -> None:
    """The life of a process: answer tasks until the other side is gone."""
    try:
        pipe.send(_READY)
        while True:
            pipe.send(function(pipe.recv()))
    except (EOFError, BrokenPipeError):
        return


@contextmanager
def _interrupts_blocked() -> Iterator[None]:
    """Keep Ctrl-C from a process started inside: it is for the parent alone to answer.

    A blocked signal stays blocked across the start of the process, from its first instruction
    on; one that arrives here meanwhile is delivered on leaving.
    """
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
