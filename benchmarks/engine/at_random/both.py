"""Run scripts on both engines, seed after seed."""

from __future__ import annotations

import argparse
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path

from minidem import run_script

__all__ = ["LIGGGHTS", "MINIDEM", "each_seed", "run_both", "seeds"]

MINIDEM, LIGGGHTS = "minidem", "liggghts"
"""Folders of the two engines, in that of a seed."""


def run_both(folder: Path, text: str, meshes: Mapping[str, str]) -> str:
    """Run a script on both engines, each in a folder of its own.

    Parameters
    ----------
    folder : Path
        Is made, with the two folders.
    text : str
        The script.
    meshes : mapping of str to str
        Name and text of files beside it.

    Returns
    -------
    str
        Who refuses it and why, empty if both have run it.
    """
    for engine in (MINIDEM, LIGGGHTS):
        place = folder / engine
        place.mkdir(parents=True)
        for name, content in {"in.script": text, **meshes}.items():
            (place / name).write_text(content)
    program = shutil.which("liggghts") or "liggghts"
    done = subprocess.run(
        ["stdbuf", "-oL", program, "-in", "in.script"], cwd=folder / LIGGGHTS, check=False,
        capture_output=True, text=True, errors="replace", timeout=300,
    )  # fmt: skip
    error = next((line for line in done.stdout.splitlines() if "ERROR" in line), "")
    try:
        run_script(folder / MINIDEM / "in.script", root=folder / MINIDEM)
    except RuntimeError as err:
        verdict = "both refuse" if done.returncode else "MINIDEM FAILS"
        return f"{verdict}: {err} | {error}"
    return f"LIGGGHTS FAILS: {error}" if done.returncode else ""


def seeds(doc: str | None) -> argparse.ArgumentParser:
    """Return a parser of the words that choose seeds; the first line of `doc` describes it."""
    parser = argparse.ArgumentParser(description=(doc or "").splitlines()[0])
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--count", type=int, default=20, help="number of seeds")
    parser.add_argument("--keep", type=Path, help="folder that keeps scripts and outputs")
    return parser


def each_seed(args: argparse.Namespace, compare: Callable[[int, Path], str]) -> None:
    """Print what `compare` says of every seed, given a folder that is not there yet."""
    for seed in range(args.first, args.first + args.count):
        with tempfile.TemporaryDirectory() as spare:
            folder = (args.keep or Path(spare)) / str(seed)
            shutil.rmtree(folder, ignore_errors=True)
            print(f"{seed:5d} {compare(seed, folder)}", flush=True)
