"""The command `challenge make`."""

from __future__ import annotations

import hashlib
import subprocess
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from threadpoolctl import threadpool_limits

from calibrate.cli.arguments import AsJson, DryRun, Quiet, Workers, named_directory
from calibrate.cli.show.output import Screen
from calibrate.cli.show.waiting import Waiting
from calibrate.errors import CalibrationError
from calibrate.runs.executors.run_options import RunOptions
from liggghts_io.files import shell_word

if TYPE_CHECKING:
    from calibrate.challenge.making import Plan
    from calibrate.challenge.rules import Rules

__all__ = ["make"]


def make(
    rules: Annotated[Path, typer.Argument(metavar="RULES.toml", help="Rules of the suite.")],
    out: Annotated[
        str | None, typer.Option("--out", metavar="DIR", help="Default: the name of the rules.")
    ] = None,
    seed: Annotated[
        str, typer.Option("--seed", metavar="TEXT", help="Default: the commit of the rules.")
    ] = "",
    workers: Workers = 0,
    dry_run: DryRun = False,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> None:
    """Make studies with hidden causes: draw them, run their experiments, seal the truths.

    All draws follow from the commit that holds the rules, which nobody knows before it is made.
    Started again, it goes on where it was.

    Example: bulkcal challenge make cases/challenge/suite_1.toml --dry-run
    """
    screen = Screen(quiet)
    with Waiting(screen.console, f"reading {rules}") as wait:
        from calibrate.challenge.folders import Suite
        from calibrate.challenge.learnt import learnt_of
        from calibrate.challenge.making import make_suite, plan_of
        from calibrate.challenge.opening import checked_truths
        from calibrate.challenge.rules import load_rules
        from calibrate.cli.running import running
        from calibrate.cli.show.progress import RunsBar

        asked = load_rules(rules)
        text = seed or _commit_of(rules)
        wait.tell("learning from the runs of the design")
        begun = Suite(Path(out or asked.name))
        # Matrices are small and many: threads of the linear algebra get in each other's way.
        with threadpool_limits(limits=1):
            data, learnt = learnt_of(asked, rules.parent)
            sealed = checked_truths(begun) if begun.is_begun else {}
            plan = plan_of(asked, data, learnt, text, list(sealed.values()), wait.tell)
        facts = _facts(asked, plan, rules.parent, text)
    if dry_run:
        screen.plan(facts, as_json)
        return
    folder = named_directory("--out", out or asked.name)
    folder.mkdir(parents=True, exist_ok=True)
    screen.hint(f"{facts['runs']} runs, {facts['core_hours']:.1f} core hours; see --dry-run")
    tables = b"".join((rules.parent / one).read_bytes() for one in asked.tables)
    note = {"seed": text, "design": hashlib.sha256(tables).hexdigest()}
    bar = RunsBar("studies", screen.console)
    with running(folder, RunOptions(workers=workers), bar) as campaign:
        make_suite(asked, data, learnt, plan, campaign, Suite(folder), note, screen.hint)
    screen.hint(
        f"next: bulkcal challenge forecast {shell_word(folder)} --rules {shell_word(rules)}"
    )


def _facts(rules: Rules, plan: Plan, folder: Path, seed: str) -> dict[str, Any]:
    """Return what a suite would be and cost."""
    from calibrate.challenge.making import seconds_of
    from calibrate.runs.table import read_rows

    known = [row for one in rules.tables for row in read_rows(folder / one)]
    rows = [row for row in known if row.result.status == "ok"]
    took = seconds_of(plan.specs, [row.spec for row in rows], [row.result.wall_s for row in rows])
    kinds = rules.kinds()
    return {
        "suite": rules.name,
        "seed": seed,
        "studies": {kind: kinds.count(kind) for kind in dict.fromkeys(kinds)},
        "runs": len(plan.specs),
        "on_liggghts": sum(spec.engine == "liggghts" for spec in plan.specs),
        "core_hours": round(took / 3600.0, 2),
    }


def _commit_of(path: Path) -> str:
    """Return the commit that holds a file as it is.

    Raises
    ------
    CalibrationError
        If the file is in none.
    """
    words = ["git", "-C", str(path.parent), "log", "-1", "--format=%H", "--", path.name]
    changed = ["git", "-C", str(path.parent), "status", "--porcelain", "--", path.name]
    try:
        commit, dirty = (
            subprocess.run(one, capture_output=True, text=True, check=True, timeout=30).stdout
            for one in (words, changed)
        )
    except (OSError, subprocess.SubprocessError):
        commit, dirty = "", ""
    if dirty.strip() or not commit.strip():
        msg = (
            f"{path}: in no commit as it is, so there is no seed that nobody could know; "
            "commit it, or give --seed TEXT"
        )
        raise CalibrationError(msg)
    return commit.strip()
