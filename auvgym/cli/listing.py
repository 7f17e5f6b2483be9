"""``auvgym list``: what there is, by name."""

from __future__ import annotations

import enum
from collections.abc import Iterator
from typing import Annotated

import typer

from auvgym.cli.console import output


class Kind(enum.Enum):
    """What can be listed."""

    environments = "environments"
    scenarios = "scenarios"
    planners = "planners"
    policies = "policies"
    suites = "suites"
    cards = "cards"


def list_names(
    kind: Annotated[Kind | None, typer.Argument(help="One kind only; by default all.")] = None,
) -> None:
    """List environments, scenarios, planners, policies, suites and cards.

    [dim]Example:[/] auvgym list policies
    """
    from rich.table import Table

    console = output()
    for one in [kind] if kind else list(Kind):
        table = Table(box=None, padding=(0, 2, 0, 0), show_header=False)
        table.add_column(style="cyan", no_wrap=True)
        table.add_column()
        for name, description in _ROWS[one]():
            table.add_row(name, description)
        console.print(one.value, style="bold")
        console.print(table)
        if kind is None:
            console.print()


def _environments() -> Iterator[tuple[str, str]]:
    from gymnasium.envs.registration import load_env_creator

    from auvgym.registration import ENVIRONMENTS

    for name, entry_point in sorted(ENVIRONMENTS.items()):
        # The class's docstring is the specification; its first line says what it is.
        yield name, (load_env_creator(entry_point).__doc__ or "").partition("\n")[0]


def _scenarios() -> Iterator[tuple[str, str]]:
    import auvgym

    for name in auvgym.list_scenarios():
        yield name, str(auvgym.World(name).scenario.to_dict().get("description") or "")


def _planners() -> Iterator[tuple[str, str]]:
    import auvgym

    for name in auvgym.list_planners():
        yield name, ""
    for name in auvgym.ompl.PLANNERS:
        yield name, 'needs pip install "auvgym[ompl]"'


def _policies() -> Iterator[tuple[str, str]]:
    import auvgym
    from auvgym import policies

    for name in [*auvgym.list_policies(), *policies.list_triggers()]:
        policy = policies.make(name)
        yield name, f"{getattr(policy, 'description', '')} (knows: {policy.knows})"
    for name in policies.list_agents():
        if name not in auvgym.list_policies():
            yield name, 'needs pip install "auvgym[agents]"'


def _suites() -> Iterator[tuple[str, str]]:
    from auvgym import evaluation

    for name in evaluation.list_suites():
        suite = evaluation.load_suite(name)
        yield name, f"{suite.description} {len(suite.instances)} instances, hash {suite.hash}"


def _cards() -> Iterator[tuple[str, str]]:
    from auvgym import reproduction

    for name in reproduction.list_cards():
        card = reproduction.load_card(name)
        yield name, f"{card.title}: {card.source}"


_ROWS = {
    Kind.environments: _environments,
    Kind.scenarios: _scenarios,
    Kind.planners: _planners,
    Kind.policies: _policies,
    Kind.suites: _suites,
    Kind.cards: _cards,
}
