"""The campaign that is tormented: python -m tests.torture.program DIR ENGINE CASES WORKERS.

A campaign of real cases without the statistics around it, so that it starts within a second. Every
start of an engine leaves a line in the file that TORTURE_STARTS names. The last line on stdout is
the table of runs as JSON.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from calibrate.errors import CalibrationError, Terminated
from calibrate.runs.stored import RUNS, stored_case
from calibrate.study.resources import bundled_particles
from liggghts_io import CaseError, CaseResult, CaseSpec, execute, particle_named
from liggghts_io.case import attempt

STARTS = "TORTURE_STARTS"
PLATE = {"mass_fraction": 0.02, "flow_factor": 10.0, "frames": 4.0, "flight_s": 0.3}
BELT = {"length_fraction": 0.02, "pour_half_width_d": 1.0, "skin_d": 0.5, "frames": 3.0}
REFUSED, INTERRUPTED, TERMINATED = 2, 130, 143


def specs(engine: str, cases: int) -> list[CaseSpec]:
    """Return small cases of both kinds: with boxes, and with a table beside the result."""
    grain = particle_named("Carbo HSP13", bundled_particles())
    contact = {
        "mu_pp": 0.5, "mu_roll_pp": 0.2, "mu_pw": 0.3, "mu_roll_pw": 0.2, "e_pp": 0.6, "e_pw": 0.6,
    }  # fmt: skip
    kinds = (("plate_impact", PLATE), ("conveyor", BELT))
    return [
        CaseSpec(kind, grain, "steel", "quick", contact, apparatus, seed=seed, engine=engine)
        for seed in range(1, cases + 1)
        for kind, apparatus in (kinds[seed % 2],)
    ]


def counted(run_engine: Callable[..., Any]) -> Callable[..., Any]:
    """Return `run_engine` with a line in the log of starts for every call."""

    def run(*arguments: Any, **options: Any) -> Any:
        with Path(os.environ[STARTS]).open("a", encoding="utf-8") as file:
            file.write(f"{os.getpid()} {arguments[0]}\n")
        return run_engine(*arguments, **options)

    run.__name__ = "counted_run_engine"
    return run


def execute_counted(spec: CaseSpec, root: Path) -> CaseResult:
    """Run a case in a worker, counting what is really run."""
    if attempt.run_engine.__name__ != "counted_run_engine":
        attempt.run_engine = counted(attempt.run_engine)
    return execute(spec, root)


def rows(specs_: list[CaseSpec], results: list[CaseResult]) -> list[dict[str, Any]]:
    """Return what must be equal to the last bit however the campaign was disturbed."""
    return [
        {
            "experiment": spec.experiment,
            "seed": spec.seed,
            "case_id": one.case_id,
            "status": one.status,
            "failure": str(one.failure),
            "observables": dict(one.observables),
            "tables": dict(one.tables),
        }
        for spec, one in zip(specs_, results, strict=True)
    ]


def main(out: Path, engine: str, cases: int, workers: int) -> None:
    """Run the campaign in `out`, as `bulkcal calibrate` would."""
    # Not at the top of the file: workers read that too, and need no pandas.
    from calibrate.cli.ending import result_directory, said_how_to_continue
    from calibrate.runs.campaign import Campaign
    from calibrate.runs.others import held_case

    def say(line: str) -> None:
        print(line, file=sys.stderr, flush=True)

    asked = specs(engine, cases)
    try:
        result_directory(out)
        with said_how_to_continue(out, "the same again", say), Campaign(
            out / RUNS, execute_counted, stored=stored_case, held=held_case,
            workers=workers, tell=say,
        ) as campaign:  # fmt: skip
            results = campaign.results(asked, "torture")
    except (CalibrationError, CaseError) as err:
        say(f"refused: {err}")
        raise SystemExit(REFUSED) from err
    except Terminated:
        raise SystemExit(TERMINATED) from None
    except KeyboardInterrupt:
        raise SystemExit(INTERRUPTED) from None
    print(json.dumps(rows(asked, results)))


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2], int(sys.argv[3]), int(sys.argv[4]))
