"""Which seeds are for what: named ranges that do not meet.

A seed is what ``reset`` is given; it draws the number of an episode out of 2**63, and a training
draws on from there. No two ranges share a seed, so that worlds met in training are met again in a
test with a probability of about 1e-9.
"""

from __future__ import annotations

from auvgym._names import unknown

SEEDS: dict[str, range] = {
    # Frozen suites, and whatever anybody looks at.
    "boards": range(100_000),
    # Looked at once, when an agent is finished.
    "test": range(100_000, 200_000),
    # Looked at while training, to keep the best network.
    "validation": range(200_000, 300_000),
    # Environment i of a training with seed s begins with 1 000 000 + 1 000 000 s + i.
    "training": range(1_000_000, 2**31),
}
_RUN, _PART = 1_000_000, 10_000


def seeds_of(name: str, count: int) -> range:
    """The first ``count`` seeds of a named range.

    Raises:
        ValueError: there is no range of that name, or it has not so many.
    """
    if name not in SEEDS:
        raise ValueError(unknown("range of seeds", name, SEEDS))
    if not 1 <= count <= len(SEEDS[name]):
        raise ValueError(f"count = {count}: {name} has 1 .. {len(SEEDS[name])} seeds")
    return SEEDS[name][:count]


def training_seed(seed: int, part: int = 0) -> int:
    """The seed of a training's first environment; ``part`` counts how often it was resumed.

    A training that goes on must not fly the episodes of its beginning again, so that each part has
    seeds of its own.
    """
    return SEEDS["training"].start + _RUN * seed + _PART * (part % (_RUN // _PART))
