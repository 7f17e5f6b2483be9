"""A pool of processes that loses one task, not the run, when a process dies."""

from __future__ import annotations

import multiprocessing
import signal
from collections import deque
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from typing import Any, Generic, TypeVar

Task = TypeVar("Task")
Result = TypeVar("Result")
_ENDING_SECONDS = 0.5


class ProcessDiedError(Exception):
    """The process that had a task in hand ended; its text says how."""


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
                    result = worker.pipe.recv()
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
    """Hand over a task; a process that is gone already is noticed at the next read."""
    try:
        worker.give(task)
    except OSError:
        worker.task = task


def _how_it_died(worker: _Worker[Any]) -> ProcessDiedError:
    worker.end()
    return ProcessDiedError(f"the process ended with exit code {worker.process.exitcode}")


def _serve(function: Callable[[Any], Any], pipe: Connection) -> None:
    """The life of a process: answer tasks until the other side is gone."""
    try:
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
