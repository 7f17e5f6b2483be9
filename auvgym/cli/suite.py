"""``auvgym suite``: what a suite holds, and whether its worlds are still what they were."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from auvgym.cli.console import fail, messages, output

if TYPE_CHECKING:
    from auvgym.evaluation import Suite


def suite(
    name: Annotated[str, typer.Argument(help="A shipped suite, or a TOML file of one's own.")],
    check: Annotated[
        bool, typer.Option("--check", help="Draw every world and hold it to the frozen hash.")
    ] = False,
    freeze: Annotated[
        bool,
        typer.Option("--freeze", help="Write the hashes of a file's worlds to its .lock."),
    ] = False,
) -> None:
    """Show a suite: its instances by stratum, its hash.

    A frozen suite names the hash of every world: a world that has changed, by a new version of
    auvgym or of the data, is an error and not a silent difference.

    [dim]Example:[/] auvgym suite standard --check
    """
    from auvgym.evaluation import load_suite
    from auvgym.evaluation.suite import stratum_label

    loaded = load_suite(name)
    if freeze:
        _freeze(name, loaded)
        loaded = load_suite(name)
    console = output()
    state = "frozen" if loaded.frozen else "not frozen"
    console.print(
        f"{loaded.name}: {len(loaded.instances)} instances, hash {loaded.hash}, {state}",
        style="bold",
    )
    if loaded.description:
        console.print(loaded.description, markup=False)
    for stratum, count in loaded.strata.items():
        console.print(f"{count:6}  {stratum_label(stratum)}", markup=False)
    if check:
        changed = _changed(loaded)
        for text in changed:
            console.print(text, style="red", markup=False, soft_wrap=True)
        if changed:
            raise typer.Exit(1)
        console.print("Every world is as it was frozen.", style="green")


def _freeze(name: str, suite: Suite) -> None:
    from auvgym.evaluation.suite_file import lock_path, lock_text

    if not name.endswith(".toml"):
        fail(f'suite "{name}" is shipped, and frozen with auvgym; --freeze is for a file')
    lock_path(name).write_text(lock_text(suite, _hashes(suite)), encoding="utf-8")


def _changed(suite: Suite) -> list[str]:
    if not suite.frozen:
        fail(f'suite "{suite.name}" is not frozen: there is nothing to hold its worlds to')
    pairs = zip(suite.instances, _hashes(suite), strict=True)
    return [text for instance, digest in pairs if (text := instance.change(digest))]


def _hashes(suite: Suite) -> list[str]:
    from auvgym.cli.progress import progress_bar
    from auvgym.evaluation.suite_file import world_hashes

    with progress_bar(messages()) as bar:
        drawn = bar.add_task("worlds", total=len(suite.instances))
        return world_hashes(suite, lambda count: bar.update(drawn, completed=count))
