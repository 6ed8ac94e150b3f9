"""Plan, run and report the comparison; see README.md beside this file."""

from __future__ import annotations

import argparse
from pathlib import Path

from benchmarks.peers.campaign import BUDGETS, TRUTHS, Task, run_campaign
from benchmarks.peers.joint_fits.fits import fit_all
from benchmarks.peers.joint_fits.planted import SETS
from benchmarks.peers.joint_fits.table import load_fits, print_fits
from benchmarks.peers.methods.acces import Acces
from benchmarks.peers.methods.decalioc import Decalioc
from benchmarks.peers.methods.grain_learning import GrainLearning
from benchmarks.peers.methods.joint import Joint
from benchmarks.peers.methods.middle import Middle
from benchmarks.peers.methods.staged import Staged
from benchmarks.peers.plan import print_plan, print_sensitivity
from benchmarks.peers.report import STORED, load_scores, print_report
from benchmarks.peers.simulator import Engine

METHODS = {
    method.name: method
    for method in (
        Middle(),
        Joint(),
        Staged(),
        Decalioc(),
        GrainLearning(20),
        GrainLearning(50),
        Acces("Product"),
        Acces("Sum"),
    )
}


def main() -> None:
    """Read the command line and do what it says."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.peers", description=__doc__)
    verbs = parser.add_subparsers(dest="verb", required=True)
    for verb in ("plan", "sensitivity", "run", "joint"):
        sub = verbs.add_parser(verb)
        sub.add_argument("folder", type=Path, help="the campaign's folder, outside the project")
        if verb == "run":
            sub.add_argument("--truths", type=int, default=TRUTHS)
            sub.add_argument(
                "--methods",
                nargs="+",
                type=task,
                default=[task(name) for name in METHODS],
                metavar="NAME[:BUDGET...]",
                help="methods in turn with their budgets, all by default",
            )
        if verb == "joint":
            sub.add_argument("--sets", type=int, default=SETS, help="planted sets of each kind")
    sub = verbs.add_parser("joint-report")
    sub.add_argument("folder", type=Path, nargs="?", help="without it, the stored fits")
    sub.add_argument("--store", action="store_true", help="write the fits beside the program")
    sub = verbs.add_parser("report")
    sub.add_argument("folder", type=Path, nargs="?", help="without it, the stored table")
    sub.add_argument("--methods", nargs="+", default=[], help="compared over truths they share")
    sub.add_argument("--figure", type=Path)
    sub.add_argument("--store", action="store_true", help="write the scores beside the program")
    args = parser.parse_args()
    if args.verb == "report":
        report(args)
        return
    if args.verb == "joint-report":
        print_fits(load_fits(args.folder), store=args.store)
        return
    folder = args.folder.resolve()
    if args.verb == "plan":
        print_plan(Engine(folder), len(METHODS))
    elif args.verb == "sensitivity":
        print_sensitivity(Engine(folder))
    elif args.verb == "joint":
        fit_all(folder, Engine(folder), args.sets)
    else:
        run_campaign(folder, Engine(folder), args.methods, range(args.truths))


def task(words: str) -> Task:
    """Read a method and its budgets, such as ``decalioc:20:100``."""
    name, *budgets = words.split(":")
    if name not in METHODS:
        msg = f"{name}: no such method; there are {', '.join(METHODS)}"
        raise argparse.ArgumentTypeError(msg)
    usual = BUDGETS[:1] if name == Middle.name else BUDGETS  # it is the same at every budget
    return Task(METHODS[name], tuple(map(int, budgets)) or usual)


def report(args: argparse.Namespace) -> None:
    """Print, draw and store what a campaign has found so far."""
    scores = load_scores(args.folder)
    print_report(scores, args.methods, args.figure)
    if args.store:
        scores.to_csv(STORED, index=False, float_format="%.6g")


if __name__ == "__main__":
    main()
