"""The same tasks on a Ray cluster (extra ``ray``): lanes are Ray actors, results the same."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Generator, Sequence
from typing import Any, TypeVar

from auvgym._extras import require
from auvgym.evaluation.workers import Lane, ProcessDiedError

Task = TypeVar("Task")
Result = TypeVar("Result")


def run_tasks_on_ray(
    function: Callable[[Task], Result], tasks: Sequence[Task], workers: int
) -> Generator[tuple[Task, Result | ProcessDiedError], None, None]:
    """As :func:`auvgym.evaluation.workers.run_tasks`, ``workers`` tasks at a time on Ray.

    Joins the cluster that ``RAY_ADDRESS`` names, or the one this program joined before; otherwise
    it begins one on this machine, and ends it. Each actor flies in a process of its own within its
    node, so that a policy's end is told as it is everywhere. auvgym of the same version has to be
    installed on every node.

    Raises:
        ImportError: without ray; says which extra brings it.
    """
    ray: Any = require("ray", "ray")
    ours = not ray.is_initialized()
    if ours:
        ray.init(**_settings(ray, workers))
    actors: dict[Any, tuple[Any, Task]] = {}
    try:
        make = ray.remote(num_cpus=1, max_restarts=0)(Lane).remote
        waiting = deque(tasks)
        for _ in range(min(workers, len(waiting))):
            actor, task = make(function), waiting.popleft()
            actors[actor.run.remote(task)] = actor, task
        while actors:
            [ready], _ = ray.wait(list(actors), num_returns=1)
            actor, task = actors.pop(ready)
            result: Result | ProcessDiedError
            try:
                result = ray.get(ready)
            except ray.exceptions.RayActorError:
                # The node is gone, and with it nothing but this task's flight.
                actor, result = make(function), ProcessDiedError(None)
            if waiting:
                following = waiting.popleft()
                actors[actor.run.remote(following)] = actor, following
            else:
                ray.kill(actor)
            yield task, result
    finally:
        for actor, _ in actors.values():
            ray.kill(actor)
        if ours:
            ray.shutdown()


def _settings(ray: Any, workers: int) -> dict[str, Any]:
    import os

    if os.environ.get("RAY_ADDRESS"):
        return {"log_to_driver": False}
    return {"num_cpus": workers, "include_dashboard": False, "log_to_driver": False}
