"""Tables of what was measured, in Markdown that also reads well in a terminal."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from runs import CHAIN, Row

Column = tuple[str, Callable[[Row], str]]

_STAGES = (*CHAIN, "tubes")
_PLACEMENT = ("placement",)

MEASURES: list[Column] = [
    ("CPU s", lambda row: f"{row.best('cpu'):.2f}"),
    ("of it placement", lambda row: "" if row.is_peer else f"{row.best('cpu', _PLACEMENT):.2f}"),
    ("wall s", lambda row: f"{row.best('wall'):.2f}"),
    ("memory MB", lambda row: f"{row.peak_memory:.0f}"),
    ("n", lambda row: f"{row.quality['n']:.0f}"),
    ("L_avg mm", lambda row: f"{row.quality['mean_length']:.2f}"),
    ("weighted mm", lambda row: f"{row.quality['length_weighted_mean']:.1f}"),
    ("d_avg/d_sep", lambda row: f"{row.quality['mean_spacing_ratio']:.3f}"),
    ("short", lambda row: f"{row.quality['short_fraction']:.1%}"),
]

CHECKS: list[Column] = [
    ("least separation", lambda row: f"{row.checked['min_separation_surface']:.4f}"),
    ("too close", lambda row: f"{row.checked['violating_fraction']:.2%}"),
    ("own parts", lambda row: f"{row.checked['min_self_separation']:.3f}"),  # 9: never within d_sep
    ("coverage", lambda row: f"{row.checked['coverage']:.4f}"),
    ("largest gap", lambda row: f"{row.checked['largest_gap']:.2f}"),
    ("off surface", lambda row: f"{row.checked['off_surface']:g}"),
    ("field angle", lambda row: f"{row.checked['field_angle_deg']:g}"),
]

# Time, memory and spacing are peer / ours, lengths are ours / peer: above 1 is in our favour everywhere.
RATIOS: list[tuple[str, Callable[[Row, Row], float]]] = [
    ("CPU, peer / ours", lambda ours, peer: peer.best("cpu") / ours.best("cpu")),
    ("placement alone", lambda ours, peer: peer.best("cpu") / ours.best("cpu", _PLACEMENT)),
    ("wall, peer / ours", lambda ours, peer: peer.best("wall") / ours.best("wall")),
    ("memory, peer / ours", lambda ours, peer: peer.peak_memory / ours.peak_memory),
    ("d_avg, peer / ours", lambda ours, peer: peer.quality["mean_spacing_ratio"] / ours.quality["mean_spacing_ratio"]),
    ("L_avg, ours / peer", lambda ours, peer: ours.quality["mean_length"] / peer.quality["mean_length"]),
    (
        "weighted, ours / peer",
        lambda ours, peer: ours.quality["length_weighted_mean"] / peer.quality["length_weighted_mean"],
    ),
]


def measures_table(rows: Sequence[Row]) -> str:
    """Time, memory and quality of every engine."""
    return _table(["engine"], MEASURES, [([row.name], row) for row in rows])


def checks_table(rows: Sequence[Row]) -> str:
    """What the external checker found; empty where it did not run."""
    checked = [([row.name], row) for row in rows if row.checked]
    return _table(["engine"], CHECKS, checked) if checked else ""


def stage_table(rows: Sequence[Row]) -> str:
    """Share of each of our stages in the CPU time from arrays to tubes; empty where we have no result."""

    def share(stage: str) -> Callable[[Row], str]:
        return lambda row: f"{row.best('cpu', (stage,)) / row.best('cpu', _STAGES):.1%}"

    ours = [([row.method], row) for row in _ours(rows)]
    return _table(["CPU time by stage"], [(stage, share(stage)) for stage in _STAGES], ours) if ours else ""


def ratio_table(cases: Sequence[tuple[str, Sequence[Row]]]) -> str:
    """How the peer compares with each of our methods; empty where either is missing."""
    lines = [
        [label, ours.method, *(f"{ratio(ours, peer):.2f}x" for _, ratio in RATIOS)]
        for label, rows in cases
        for peer in (row for row in rows if row.is_peer and not row.failure)
        for ours in _ours(rows)
    ]
    titles = ["surface and options", "method", *(title for title, _ in RATIOS)]
    return align(titles, lines, left=2) if lines else ""


def failures(rows: Sequence[Row]) -> list[str]:
    """Say which engines have no result and why."""
    return [f"{row.name}: {row.failure}" for row in rows if row.failure]


def _ours(rows: Sequence[Row]) -> list[Row]:
    return [row for row in rows if not row.is_peer and not row.failure]


def _table(first: list[str], columns: Sequence[Column], rows: Sequence[tuple[list[str], Row]]) -> str:
    lines = [[*names, *_cells(columns, row)] for names, row in rows]
    return align([*first, *(title for title, _ in columns)], lines, left=len(first))


def _cells(columns: Sequence[Column], row: Row) -> list[str]:
    if row.failure:
        return [row.failure.partition(":")[0], *("" for _ in columns[1:])]
    return [show(row) for _, show in columns]


def align(titles: list[str], lines: Sequence[list[str]], left: int) -> str:
    """Pad cells to columns, the first `left` of them aligned to the left."""
    widths = [max(map(len, column)) for column in zip(titles, *lines, strict=True)]
    rule = [
        ":" + "-" * (width - 1) if column < left else "-" * (width - 1) + ":" for column, width in enumerate(widths)
    ]
    return "\n".join(
        "| "
        + " | ".join(
            cell.ljust(width) if column < left else cell.rjust(width)
            for column, (cell, width) in enumerate(zip(line, widths, strict=True))
        )
        + " |"
        for line in [titles, rule, *lines]
    )
