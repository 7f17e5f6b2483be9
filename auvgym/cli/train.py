"""``auvgym train``: an agent by a recipe, with its curve, its card and its network as ONNX."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from auvgym.cli.console import INTERRUPTED, messages, output, parse_settings
from auvgym.cli.progress import progress_bar

if TYPE_CHECKING:
    from auvgym.training import TrainingConfig, TrainingResult
    from auvgym.training.curve import Row


def train(
    algorithm: Annotated[
        str, typer.Argument(help="ppo, recurrent-ppo, sac, tqc; dqn for action_mode=replan.")
    ],
    environment: Annotated[str, typer.Option("--env", help="Environment id.")] = "AUVDynamic2D-v0",
    timesteps: Annotated[
        float | None, typer.Option(help="Legs to fly in all, as 2e6 (default: the recipe's).")
    ] = None,
    difficulty: Annotated[
        str | None, typer.Option(help="easy, normal or hard (default: normal).")
    ] = None,
    seed: Annotated[int, typer.Option(help="Of networks, draws and episodes.")] = 0,
    hyperparameters: Annotated[
        list[str] | None,
        typer.Option("--set", help="A hyperparameter, key=value, over the recipe's; repeatable."),
    ] = None,
    settings: Annotated[
        list[str] | None,
        typer.Option(
            "--env-set", help="An argument of the environment, as action_mode=replan; repeatable."
        ),
    ] = None,
    validate_every: Annotated[
        float, typer.Option(help="Legs between two looks at the validation seeds.")
    ] = 1e5,
    validation_episodes: Annotated[int, typer.Option(help="How many of these seeds.")] = 256,
    torch_threads: Annotated[
        int,
        typer.Option(help="For the networks; the engine has threads of its own."),
    ] = 1,
    out: Annotated[
        Path | None, typer.Option(help="Folder of the training (default: results/train/NAME).")
    ] = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on with the training in this folder.")
    ] = False,
    fresh: Annotated[
        bool, typer.Option("--fresh", help="Forget the training in this folder first.")
    ] = False,
) -> None:
    """Train an agent with Stable-Baselines3, and write it as ONNX with a card (extra `train`).

    It learns by the algorithm's recipe for the environment, on the range of seeds that is for
    training. Every so often it flies the validation seeds, and the best network is kept. Ctrl-C
    saves; the same command with --resume goes on.

    [dim]Example:[/] auvgym train ppo --env AUVDynamic3D-v0 --timesteps 2e6

    [dim]Then:[/] tensorboard --logdir results/train

    [dim]Then:[/] auvgym evaluate --policy results/train/ppo-AUVDynamic3D-v0-normal/agent.onnx
    --env AUVDynamic3D-v0 --seeds test --episodes 1000
    """
    from auvgym import training
    from auvgym.training.config import whole_number

    # Torch's threads shall not spin on the engine's cores; it reads this when it is imported.
    os.environ.setdefault("OMP_WAIT_POLICY", "PASSIVE")
    chosen = parse_settings(settings, "--env-set")
    if difficulty is not None:
        chosen["difficulty"] = difficulty
    config = training.configure(
        algorithm,
        environment,
        timesteps,
        settings=chosen,
        hyperparameters=parse_settings(hyperparameters),
        seed=seed,
        validate_every=whole_number("--validate-every", validate_every),
        validation_episodes=validation_episodes,
        torch_threads=torch_threads,
    )
    folder = out if out is not None else Path("results") / "train" / config.name
    result = _watched(config, folder, resume, fresh)
    best = result.best
    console = output()
    console.print(
        f"{result.timesteps} legs in {result.seconds:.0f} s; best on the validation seeds after "
        f"{best.timesteps}:",
        markup=False,
        soft_wrap=True,
    )
    console.print(_line(best), markup=False, soft_wrap=True)
    console.print(f"Agent:    {folder / 'agent.onnx'}", soft_wrap=True, markup=False)
    console.print(f"Curve:    {folder / 'curve.csv'}", soft_wrap=True, markup=False)


def _watched(config: TrainingConfig, folder: Path, resume: bool, fresh: bool) -> TrainingResult:
    """Train under a progress bar; on Ctrl-C say what is kept, and exit with 130."""
    from auvgym import training

    console = messages()
    bar = progress_bar(console)
    with bar:
        task = bar.add_task(config.algorithm, total=config.timesteps)
        try:
            return training.train(
                config,
                folder,
                resume=resume,
                fresh=fresh,
                on_progress=lambda done, total: bar.update(task, completed=done, total=total),
                on_row=lambda row: console.print(_line(row), markup=False, soft_wrap=True),
            )
        except KeyboardInterrupt:
            bar.stop()
            kept = (folder / "last.zip").is_file()
            text = (
                f"Stopped. {folder} is kept; the same command with --resume goes on from there."
                if kept
                else "Stopped before there was anything to keep."
            )
            console.print(text, style="yellow", markup=False, soft_wrap=True)
            raise typer.Exit(INTERRUPTED) from None


def _line(row: Row) -> str:
    from auvgym.training.flights import wilson_text

    success = wilson_text(row.success, row.success_low, row.success_high)
    star = "  best" if row.best else ""
    return (
        f"{row.timesteps:>10}  {row.seconds:6.0f} s  arrived {success}  return {row.return_:.3f}  "
        f"time/limit {row.time_share:.3f}{star}"
    )
