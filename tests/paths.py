"""Where things lie, seen from the tests."""

from pathlib import Path

ROOT = Path(__file__).parents[1]
CASES = ROOT / "cases" / "proppants"
DATA = ROOT / "tests" / "data"
