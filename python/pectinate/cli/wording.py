"""Messages of the library in the words of the command line."""

from __future__ import annotations

import re

# The flag of every keyword of the library that a command takes under another name.
_OTHER_NAMES = {
    "separation_distance": "--separation",
    "seed_count": "--seeds",
    "thread_count": "--threads",
    "side_count": "--tube-sides",
    "tube radius": "--tube-radius",
    "tube height": "--tube-height",
    "outer_loop": "--outer",
    "inner_loop": "--inner",
    "outer_loops": "--outer-first or --outer-second",
    "loop_pairs": "--pair",
}
_SAME_NAMES = (
    "abrupt_turn_angle",
    "barriers",
    "chamber",
    "close_loops",
    "conflict_angle",
    "edge_length",
    "field",
    "fill_missing",
    "how",
    "inner_point",
    "layer",
    "length",
    "max_steps",
    "maximum_distance",
    "method",
    "minimum_length",
    "occupancy",
    "outlier_angle",
    "per_vertex",
    "polishing_rounds",
    "polishing_time",
    "random_seed",
    "second",
    "seed_clearance",
    "seed_distance_factor",
    "singularity_radius",
    "taper_length",
    "test_distance",
    "units",
    "views",
)
_FLAGS = {name: f"--{name.replace('_', '-')}" for name in _SAME_NAMES} | _OTHER_NAMES


def in_flags(message: str) -> str:
    """Say `--maximum-distance` for `maximum_distance`, and `--how nearest` for `how='nearest'`.

    Names of one word are words of English too: they count where a message begins with them or gives them a value.
    """
    for name, flag in _FLAGS.items():
        message = re.sub(rf"\b{name}='([^']*)'", rf"{flag} \1", message)
        message = re.sub(rf"\b{name}\b" if "_" in name else rf"^{name}\b(?= is | = )", flag, message)
    return message
