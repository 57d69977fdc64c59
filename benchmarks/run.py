"""Measure pectinate, and the PyPI package evenlyspacedstreamlines beside it where that is installed.

`python benchmarks/run.py` runs the default scenarios of `scenarios.toml`; see `README.md` for what is measured.
"""

from __future__ import annotations

import argparse
import importlib.metadata
import importlib.util
import json
import os
import platform
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from runs import Row, Setup, run_case
from scenarios import Case, Scenario, read_scenarios
from surfaces import Arrays, SurfaceMissing, read_surface
from tables import checks_table, failures, measures_table, ratio_table, stage_table
from worker import PEER


def main(argv: Sequence[str] | None = None) -> int:
    """Run the chosen scenarios; 0 if all of them ran."""
    scenarios, default = read_scenarios()
    arguments = _parser(list(scenarios)).parse_args(argv)
    if arguments.list:
        for scenario in scenarios.values():
            print(f"{scenario.name:20} {scenario.about}{' (default)' if scenario.name in default else ''}")
        return 0
    chosen = [scenarios[name] for name in arguments.scenario or default]
    peer_installed = importlib.util.find_spec(PEER) is not None
    with tempfile.TemporaryDirectory(prefix="pectinate-bench-") as folder:
        setup = Setup(
            folder=Path(folder),
            with_peer=peer_installed and not arguments.no_peer,
            repeats=arguments.repeats,
            timeout=arguments.timeout,
            checker=arguments.check,
            log=lambda line: print(line, file=sys.stderr, flush=True),
        )
        sections, records, complete = _run_all(chosen, setup)
    if not peer_installed:
        print(f"\nto compare with {PEER}: pip install {PEER}")
    if arguments.markdown is not None:
        arguments.markdown.write_text("\n\n".join(sections) + "\n")
    if arguments.json is not None:
        arguments.json.write_text(json.dumps({"environment": _environment(), "cases": records}, indent=1) + "\n")
    return 0 if complete else 1


def _parser(names: Sequence[str]) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--list", action="store_true", help="list the scenarios and stop")
    parser.add_argument("--scenario", action="append", choices=names, metavar="NAME", help="run this one (repeatable)")
    parser.add_argument("--repeats", type=_positive, help="runs of each engine, instead of the scenario's own")
    parser.add_argument("--no-peer", action="store_true", help=f"leave out {PEER}")
    parser.add_argument("--timeout", type=float, default=600, metavar="S", help="give up one run after so long (600)")
    parser.add_argument("--check", type=Path, metavar="CHECKER", help="Python script run on a result of each engine")
    parser.add_argument("--markdown", type=Path, metavar="FILE", help="write the tables")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write every figure of every run")
    return parser


def _positive(text: str) -> int:
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError("must be at least 1")
    return number


def _run_all(scenarios: Sequence[Scenario], setup: Setup) -> tuple[list[str], list[dict[str, Any]], bool]:
    """Run and print; return the printed sections, all figures, and whether every surface was there."""
    sections: list[str] = []
    records: list[dict[str, Any]] = []
    cases: list[tuple[str, list[Row]]] = []
    complete = True
    for scenario in scenarios:
        try:
            arrays = read_surface(scenario.surface)
        except SurfaceMissing as reason:
            setup.log(f"{scenario.name}: {reason}")
            complete = False
            continue
        for case in scenario.cases():
            rows = run_case(scenario, case, arrays, setup)
            cases.append((f"{scenario.surface}, {case}", rows))
            records.append(_record(scenario, case, arrays, rows))
            sections.append(_section(cases[-1][0], len(arrays.triangles), rows))
            print(f"\n{sections[-1]}", flush=True)
    ratios = ratio_table(cases)
    if ratios:
        sections.append(f"### Ratios\n\n{ratios}")
        print(f"\n{sections[-1]}")
    return sections, records, complete


def _section(title: str, triangle_count: int, rows: Sequence[Row]) -> str:
    parts = [
        f"### {title}, {triangle_count:,} triangles",
        measures_table(rows),
        checks_table(rows),
        stage_table(rows),
        *failures(rows),
    ]
    return "\n\n".join(part for part in parts if part)


def _record(scenario: Scenario, case: Case, arrays: Arrays, rows: Sequence[Row]) -> dict[str, Any]:
    return {
        "scenario": scenario.name,
        "surface": str(scenario.surface),
        "triangles": len(arrays.triangles),
        "area": arrays.area,
        "options": vars(case),
        "engines": [row.to_dict() for row in rows],
    }


def _environment() -> dict[str, Any]:
    installed = [name for name in ("pectinate", PEER, "numpy") if importlib.util.find_spec(name) is not None]
    return {
        "versions": {name: importlib.metadata.version(name) for name in installed},
        "python": platform.python_version(),
        "system": f"{platform.system()} {platform.machine()}",
        "processors": os.cpu_count(),
    }


if __name__ == "__main__":
    sys.exit(main())
