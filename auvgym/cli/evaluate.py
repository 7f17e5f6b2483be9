"""``auvgym evaluate``: one policy over many episodes of one environment, or over a suite."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from auvgym.cli.console import output, parse_settings
from auvgym.cli.flying import STEP_LIMIT_S, Engine, EngineOption, StepLimitOption


def evaluate(
    policy: Annotated[
        str,
        typer.Option(
            "--policy",
            help="A name of `auvgym list policies`, module:Class, a file agent.onnx with its card "
            "agent.json, or an SB3 agent.zip (which runs code of its author).",
        ),
    ],
    environment: Annotated[str, typer.Option("--env", help="Environment id.")] = "AUVDynamic2D-v0",
    difficulty: Annotated[
        str | None, typer.Option(help="easy, normal or hard (default: normal).")
    ] = None,
    scenario: Annotated[
        str, typer.Option(help="A shipped scenario or a TOML file; by default each seed draws one.")
    ] = "",
    episodes: Annotated[int, typer.Option(help="How many seeds to fly.")] = 64,
    first_seed: Annotated[int, typer.Option(help="The first of them.")] = 0,
    seeds: Annotated[
        str | None,
        typer.Option(
            help="Or a range by name: test (agents are judged there), validation, training, boards."
        ),
    ] = None,
    suite: Annotated[
        str | None,
        typer.Option(help="Fly this suite instead (a name, or a TOML file)."),
    ] = None,
    seed: Annotated[int, typer.Option(help="The policy's own seed.")] = 0,
    settings: Annotated[
        list[str] | None,
        typer.Option("--set", help="A parameter of the policy, key=value; may be repeated."),
    ] = None,
    env_settings: Annotated[
        list[str] | None,
        typer.Option(
            "--env-set",
            help="A setting of the environment, key=value, as action_mode=replan; may be repeated.",
        ),
    ] = None,
    workers: Annotated[int, typer.Option(help="Processes to fly in.")] = 1,
    engine: EngineOption = Engine.processes,
    step_limit: StepLimitOption = STEP_LIMIT_S,
    out: Annotated[
        Path | None,
        typer.Option(help="Keep the episodes in FOLDER/results.db, and go on from there."),
    ] = None,
    fresh: Annotated[
        bool, typer.Option("--fresh", help="Forget what --out holds of these episodes first.")
    ] = False,
) -> None:
    """Evaluate one policy: success with its interval, time, energy, cost.

    [dim]Example:[/] auvgym evaluate --policy straight --difficulty hard --episodes 512 --workers 2

    [dim]Example:[/] auvgym evaluate --policy ppo --seeds test --episodes 1000
    """
    from auvgym import evaluation
    from auvgym.cli.flying import fly_with_progress, show

    if suite is not None and env_settings:
        raise ValueError("--env-set: a suite says what its environments are set to, leave it out")
    if seeds is not None:
        if first_seed or suite is not None:
            raise ValueError(f"--seeds {seeds}: is given without --first-seed and --suite")
        first_seed = evaluation.seeds_of(seeds, episodes).start
    instances = (
        evaluation.load_suite(suite)
        if suite is not None
        else evaluation.single_suite(
            environment, episodes, difficulty, scenario, first_seed, parse_settings(env_settings)
        )
    )
    spec = evaluation.PolicySpec(policy, seed, parse_settings(settings))
    path = None if out is None else out / "results.db"
    with evaluation.Store(path) as store:
        if fresh:
            store.forget(instances)
        results = fly_with_progress(instances, [spec], store, workers, engine.value, step_limit)
    show(results)
    if path is not None:
        output().print(f"Episodes: {path}", soft_wrap=True)
