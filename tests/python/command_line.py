"""The command line as tests call it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from pectinate.cli import ExitCode, main

SIDE = 12  # mm, of the flat square of the fixture `square`


def write_lines(path: Path, lines: list[str]) -> None:
    path.write_text("\n".join(lines) + "\n")


def run_json(capsys: pytest.CaptureFixture[str], *words: object) -> dict:
    assert main([str(word) for word in words] + ["--json"]) == ExitCode.DONE
    return json.loads(capsys.readouterr().out)


def check_error(names, capsys, words, code, said):
    for name, path in names.items():
        words = [word.replace(name, path) for word in words]
    assert main(words) == code
    error = capsys.readouterr().err
    assert error.startswith("pectinate: error: ")
    assert error.count("\n") == 1
    assert names.get(said, said) in error
    assert "fault of pectinate" not in error
