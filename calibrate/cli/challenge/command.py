"""The commands `challenge make`, `forecast` and `score`: a blind suite for the diagnosis."""

from __future__ import annotations

import typer

from calibrate.cli.challenge.forecast import forecast
from calibrate.cli.challenge.make import make
from calibrate.cli.challenge.score import score

__all__ = ["app"]

app = typer.Typer(
    name="challenge",
    help="Hide causes in studies, let the diagnosis forecast them, and score it.\n\n"
    "Start with: bulkcal challenge make RULES.toml --dry-run",
    rich_markup_mode=None,
)
app.command("make", short_help="Draw, run and seal studies.")(make)
app.command("forecast", short_help="Say what is hidden.")(forecast)
app.command("score", short_help="Open the truths.")(score)
