"""The table of what minidem understands, made from the registry of commands.

``python -m minidem.compatibility docs/compatibility.md`` writes the page; without a file name it
prints it. A test compares the page with the code.
"""

from __future__ import annotations

import sys
from collections.abc import Collection, Sequence
from pathlib import Path

from minidem.commands.command import COMMANDS
from minidem.contact.extensions import EXTENSIONS
from minidem.contact.model import LACKING, MODELS, ONLY_OFF, SETTINGS
from minidem.contact.properties import values_of_models
from minidem.insertion.region import STYLES as REGIONS
from minidem.output.dump import DUMPS
from minidem.script import names
from minidem.script.control import CONTROL
from minidem.script.formula import ARITY, GROUP_FUNCTIONS, MASKS, VECTOR_FUNCTIONS
from minidem.script.variables import STYLES
from minidem.world.compute import COMPUTES
from minidem.world.fix import FIXES

__all__ = ["main", "page"]

_HEAD = """# What minidem understands of LIGGGHTS

This page is made from the code: `python -m minidem.compatibility docs/compatibility.md`.
Reference is LIGGGHTS-PUBLIC 3.8.0. *Supported* means: same meaning, checked against that program
where a test can. Anything else is refused before the first step with file, line and word, never
skipped silently; [`minidem --check`](how-to/check-a-script.md) lists it all without a run:

    in.script:12: unknown fix 'wall/grann'; did you mean 'wall/gran'?
    in.script:41: command 'minimize' exists in LIGGGHTS but not in minidem
"""
_EXTENSIONS = """## Extensions of minidem

Effects that LIGGGHTS 3.8.0 lacks. A script with one of these words runs on minidem only; with
`minidem --strict` it is refused:

    in.script:12: 'drag/sphere' is an extension of minidem that LIGGGHTS 3.8.0 does not have;
    take it out, or run without --strict

Without strength (equal friction coefficients, exponent 0, deviation 0, stiffness factor 1, drag
factor 0) the result is that of the base model, bit for bit. Pairs with an extended contact law run
in a plainer loop, about half as fast; so do all pairs of the models `hooke/stiffness`,
`hertz/stiffness`, `hooke/hysteresis`, `luding`, `edinburgh`, `edinburgh/stiffness`,
`thornton_ning`, of `rolling_friction epsd3` and `luding`, and of the liquid bridges of
`cohesion easo/capillary/viscous` and `washino/capillary/viscous`, which have no loop of their own.
"""
_LIMITS = """## Differences that are meant

- A script is data: it starts no program, reads no environment (a variable of style `getenv` is
  empty, with a warning, unless `-var` gives a value under either name), and no file
  outside the folder of the case is read or written (no absolute path, no `..` out, no link out).
- `shell cd`, `mkdir`, `mv`, `rm` and `rmdir` are done by the engine, as LIGGGHTS has them built in,
  inside the folder of the case; options (`mkdir -p`) are passed over, and `mkdir` makes parents.
  Every other `shell` line is skipped with one warning that quotes it; `--strict` refuses it.
- Before the first command is executed the whole script is rehearsed without a step, as far as it
  follows from itself: all words that will be refused are named at once, those in branches that are
  never taken are not, and where only the simulation can tell a warning is given. LIGGGHTS finds a
  word when it gets there. A mistake behind a `run` that stops LIGGGHTS as well (an `undump` of a
  dump that there is not) is told at once too, and stops the run when it gets there, as in LIGGGHTS.
  `minidem --check SCRIPT` does the rehearsal alone ([how](how-to/check-a-script.md)).
- A script may execute 1 000 000 commands; an endless loop of jumps stops there with a message, a
  long run with Ctrl-C.
- More particles than the memory holds (1280 bytes each) are refused before they are drawn, with
  both numbers. A file that cannot be written ends the run and is named; no half file is left.
- Insertion is bit for bit that of one LIGGGHTS process. Into a `mesh/tet`, a wedge, or a cone with
  its tip up, beside particles outside of it, LIGGGHTS stops or does not look for overlap with them;
  minidem does look.
- The box is never tilted: `prism` as a box, `change_box ortho|triclinic|xy..` and `fix deform xy..`
  are refused, and so is `deform ... remap v`. Particles in the groups of two integrators, or
  of an integrator and of a `fix move` that comes later in the script, are refused; LIGGGHTS moves
  them twice a step. A particle that joins the group of a
  `fix move` by `group` starts where it is; LIGGGHTS puts it at the origin.
- Of several particles that touch a sieve for the first time in one step, LIGGGHTS throws coins in
  the order of its search bins; minidem in that of the particles.
- A `region wedge` has at most 360 degrees, tetrahedra of `mesh/tet` lie in the box, and the upper
  bound of a cone may not stand where LIGGGHTS takes the face of the box in its place.
- With `fix adapt` in a periodic box LIGGGHTS gives images of particles their new radius one step
  late; minidem does so at once.
- A mesh that is larger than a periodic box overlaps its own images; which of several coplanar
  facets acts first may then differ from LIGGGHTS.
- Images of turning meshes beyond a periodic face move as the mesh does; in LIGGGHTS their velocity
  is wrong unless the axis points that way.
- Where three or more triangles share an edge and only some of them are coplanar, the order of
  LIGGGHTS' search bins decides which takes the contacts there; minidem may choose another one.
- A mesh acts on the particles of its group, whatever the group of its `wall/gran`, as in LIGGGHTS;
  where neither is `all` the number of the wall's group counts as a sum of groups, too: in the first
  group of a script (number 1) both act on all particles, in the second on those of the first, too.
  LIGGGHTS counts only particles of the mesh's own group for its force, stress and wear; where
  others would touch it, such a mesh is refused.
- Forces between two walls: `addforce` acts before or after all walls, depending on whether it
  comes before the first wall in the script. `setforce` and `freeze` between two walls are refused,
  because the later wall would still push in LIGGGHTS.
- `timestep` must be above zero, and `run N` takes whole numbers only: LIGGGHTS reads `run 1e5` as
  one step.
- Between two runs LIGGGHTS forgets the contacts of particles with each other where a `pair_style`
  is given again, or a compute with lists of its own (`contact/atom`, `coord/atom`, `cluster/atom`,
  `rdf`) comes or goes; and before every run behind a `neigh_modify one` or `page` with another
  number than before, until that is given once more, also where it stands before the first run.
  Where such a number changes between two runs those with meshes are forgotten, too. minidem forgets
  them as well, and says so.
- `f_release_fix_insert_stream[1]` to `[14]` have values if the script names one of them before
  particles of a stream are released; asked for later they are refused, with that reason.
- `run N pre no` goes on with the last forces, as in LIGGGHTS; where anything but output, variables,
  groups, regions and velocities has changed since the run before, minidem sets the run up, with a
  warning, and LIGGGHTS goes on with lists and forces that do not know of it.
- Where LIGGGHTS reads the number that a word begins with (`4.05/2` is 4.05 in `run`, `insert/*`,
  templates, distributions, `massflow/mesh` and `check/timestep/gran`), so does minidem, with a
  warning; a word that begins with no number is refused, where LIGGGHTS reads zero.
- A grain beyond a fixed face is deleted without a word (`thermo_modify lost ignore`, the default),
  as in LIGGGHTS. With `lost error` the run stops at the next line of thermo output and names the
  grain; unlike LIGGGHTS it also stops where insertions make up for the loss.
- `read_restart` goes on from restart files of LIGGGHTS 3 as LIGGGHTS does, to rounding: particles,
  groups, contact histories, moved meshes and their wear, insertion, particles of a stream on their
  way, passages of `massflow/mesh`, springs and stored values; of one file or of one per process
  (`%`), and `*` is the highest step. What a servo remembers is not in these files and begins anew,
  with a warning; what is no sphere is refused. Unlike LIGGGHTS it asks for `pair_style` and
  `pair_coeff` again.
- `read_dump` with both `trim yes` and `add yes` keeps what it has added; which of these LIGGGHTS
  keeps is chance. As there a radius that is read changes no mass; minidem says so.
- Restart files that minidem writes have a format of their own with a checksum, so that a cut or
  changed one is refused, and continue bit for bit; `write_data` writes what LIGGGHTS reads.
  LIGGGHTS does not continue so: after
  `read_restart` it sets some particles of a stream free one step early (rounding of the remaining
  time) and seeds the random generator of the insertion face anew, so that later insertions differ.
- `compute com`, `gyration` and `msd`, and `xcm` and `gyration` in variables, count grains that come
  during a run; LIGGGHTS divides by the mass that there was at its begin.
- Insertion sees all grains that are there. LIGGGHTS overlooks one that is some five times as large
  as what it inserts, and puts grains into it; places differ from then on.
- `compute stress/atom` counts the tangential force of a contact that `limitForce on` has cut to
  nothing, as `compute pair/gran/local` shows it in both programs; LIGGGHTS counts none there. The
  motion is the same.
- `print` of sums of `stress/atom` behind a `run 0` differs by some 1e-4 of them from the line of
  thermo output, which is that of LIGGGHTS; behind a run of steps both are.
- A dump into one file is made when its first snapshot is due; LIGGGHTS makes or empties the file
  when a run begins, also where no snapshot comes.
- Three mistakes that LIGGGHTS stops at go through: `compute pair/gran/local` that is defined behind
  the first run, `print` of a compute that the last step did not need, and `fix print` of a fix
  that works at other steps.
- A particle that moves farther in one step than half its radius and the skin ends the run, with
  its number; LIGGGHTS goes on.
- Variables in `surface_vel` and `surface_ang_vel` see the particles before the move of a step,
  in LIGGGHTS behind it.
- `element_exclusion_list write` ends the run if there are duplicates, too; LIGGGHTS goes on with
  them. A script that reads the list has none.
- At the start of a run that follows another one, a grain that `insert/stream` still holds lies on
  a wall exactly at the limit of friction, and rounding decides whether it slides: the forces on
  some such grains, and on those that touch them, then differ by a few parts in a hundred.
- `luding`, `edinburgh`, `hooke/hysteresis` and `thornton_ning` keep how far a contact was loaded,
  whatever happens to the order of particles. In LIGGGHTS the numbers of `edinburgh` and
  `thornton_ning` change their sign where a pair changes the order of its two, as particles are
  sorted, and the contact is then as if it were new.
- While a contact of `edinburgh` without `fixKc` is loaded for the first time, rounding decides in
  LIGGGHTS whether its adhesion has a stiffness yet, and with it the limits of `tan_luding` and
  `rolling_friction luding`; minidem rounds the same way, but the last digits may differ. Where
  LIGGGHTS would look for its largest overlap forever, minidem stops after 1000 tries.
- `tan_luding` and `rolling_friction luding` need `luding`, `edinburgh`, `edinburgh/stiffness` or
  `thornton_ning`;
  with another model LIGGGHTS reads memory that is not its own. Their springs advance at the start
  of a run, as in LIGGGHTS; there they also advance when a compute looks at a contact.
- Liquid bridges (`easo/capillary/viscous`, `washino/capillary/viscous`) are those of the program
  and not of its manual where the two differ: the contact angle of a pair is half the product of
  both angles in radians; `minSeparationDistanceRatio` is compared with the gap over the effective
  radius; a bridge reaches to `maxSeparationDistanceRatio - 1` times the sum of the radii;
  `tangential_reduce on` lets friction see the force; the volume of an `easo` bridge is what lies
  on the caps that face each other; `f_surfaceLiquidContent` and the others are parts of the volume,
  not per cent. Both widen `contact_distance_factor` to 1.1 `maxSeparationDistanceRatio`.
- `cohesion easo/capillary/viscous` in `wall/gran` is refused: its manual has it for pairs only, and
  LIGGGHTS takes the velocity of a bridge to a wall from memory that is not its own. Bridges of
  `washino/capillary/viscous` to walls act across a gap, and not at all where grain and wall touch,
  as in LIGGGHTS; walls are dry, the liquid of meshes is not in minidem. `wall/gran/local` tells of
  walls that are touched only.
- At the setup of the first run LIGGGHTS takes images beyond periodic faces for dry, so that bridges
  through a face are weaker in the first half step; minidem has their liquid. `minidem` refuses
  `fix_modify liquidtransfer`, and a `minSeparationDistanceRatio` of 0 or less, by which LIGGGHTS
  divides.
- `thornton_ning` yields at the radius of the grain that LIGGGHTS holds first. Through a periodic
  face LIGGGHTS has each grain yield at its own radius, so that the two forces of a pair differ, and
  makes a contact new where a pair changes its order, also when grains have left; minidem does
  neither. `tangential_damping` and `limitForce` do nothing with it, and tangential damping has the
  wrong sign, as in LIGGGHTS. It gives no normal stiffness: `cdt`, `epsd` and `epsd3` are refused
  with it, as LIGGGHTS reads memory that is not its own. Where its formulas end in no number (large
  steps, much surface energy, a yield stress of 0 or less) the run stops with step and particle.
- `viscous on` damps fully where two surfaces do not approach at all; LIGGGHTS divides by zero.
  `UnloadingStiffness` of `edinburgh` below 1 is refused; LIGGGHTS takes the root of a negative
  number. `computeElasticPotential`, `computeDissipatedEnergy` and `heating_...` are known as `off`
  only: with the first LIGGGHTS also forgets contacts at separation.
- `thermo_modify format int` applies to the columns of whole numbers; LIGGGHTS prints its own format
  in place of them. Keywords such as `ke` may be asked for in formulas whether or not the thermo
  output has them; `erotate` may stand in several `thermo_style` commands.
- `tpcpu`, `spcpu`, `cu`, `cpu` and `cpuremain` are of minidem's own clock.
- `info` tells of system, groups, regions, computes, dumps, fixes and variables; about the program
  and the machine it tells nothing. The first line of a `write_data` file names minidem.
- `print ... newline no` leaves out the line end in a file, not on the screen and in the log.
- `neigh_modify once yes` and `include GROUP` are refused.
- `compute slice` of several inputs gives each of them a column; LIGGGHTS fills the first only.
- `group ID type != N` is refused: LIGGGHTS takes the particles that are equal.
- Warnings do not name a place in the source of LIGGGHTS; the timing table after a run is shorter.
- Particles in a dump without `dump_modify sort` stand in the order in which they were made, in
  LIGGGHTS in that of its spatial sorting.
- Thermo output that falls between two steps at which a fix works out its number shows the last one;
  LIGGGHTS stops there.
- A mesh that leaves the box during a run goes on; LIGGGHTS stops at the next making of its lists.
- Below a `curvature` of 1e-5 degrees rounding decides which facets of turning meshes are coplanar.
- Contacts in `dump local` stand in the order of their particles, in LIGGGHTS in that of its search
  bins. `contactPoint` of `wall/gran/local` is the point; LIGGGHTS leaves it empty.
- `displace/atom`, `store/state` and `property/atom` give particles that came later 0 or the
  default; LIGGGHTS may show what was in its memory. `set ... property/atom` needs no run before it.
- Densities of `fix ave/spatial` with `units reduced` are right; LIGGGHTS gives 0. Bins may follow a
  box that grows, which LIGGGHTS refuses.
- VTK files are ASCII, whatever `dump_modify binary` says. In `.vtr` files LIGGGHTS calls the
  coordinates by addresses in its memory, minidem by `x`, `y` and `z`.
"""


def _list(words: Collection[str]) -> str:
    return ", ".join(f"`{word}`" for word in sorted(words)) or "none"


def _section(title: str, supported: Collection[str], all_names: Collection[str]) -> list[str]:
    """Return a section: what is supported and what LIGGGHTS has besides."""
    missing = set(all_names) - set(supported)
    return [
        f"## {title}",
        "",
        "| | names |",
        "|---|---|",
        f"| supported | {_list(supported)} |",
        f"| refused: *exists in LIGGGHTS but not in minidem* | {_list(missing)} |",
        "",
    ]


def _extensions() -> list[str]:
    """Return the section of what LIGGGHTS lacks."""
    lines = [_EXTENSIONS]
    for one in EXTENSIONS.values():
        values = ", ".join(f"`{name}`".replace(" (", "` (", 1).rstrip("`") for name in one.values)
        lines += [
            f"**`{one.word}`**: {one.usage}.",
            *([f"Values: {values}."] if values else []),
            f"Law: `{one.law}`; {one.terms}.",
            f"Source: {one.source}.",
            "",
        ]
    return lines


def page() -> str:
    """Return the page as Markdown."""
    commands = {*COMMANDS, *CONTROL}
    lines = [_HEAD]
    lines += _section("Commands", commands, names.COMMANDS)
    lines += _section("Fix styles", {*FIXES} - {*EXTENSIONS}, names.FIXES)
    lines += _section("Compute styles", COMPUTES, names.COMPUTES)
    lines += _section("Dump styles", DUMPS, names.DUMPS)
    lines += [
        "## Regions, contact models and variables",
        "",
        "| | names |",
        "|---|---|",
        f"| region styles | {_list(REGIONS)} |",
        *(f"| contact model keyword `{key}` | {_list(found)} |" for key, found in MODELS.items()),
        f"| contact model settings | {_list(SETTINGS)} |",
        f"| contact model settings, `off` only | {_list(ONLY_OFF)} |",
        f"| variable styles | {_list(STYLES)} |",
        f"| functions in formulas | {_list({*ARITY, *MASKS, *VECTOR_FUNCTIONS})} |",
        f"| group functions (those the engine answers) | {_list(GROUP_FUNCTIONS - {'charge'})} |",
        "",
        "Values that contact models take with `fix property/global`, beside `youngsModulus`,",
        "`poissonsRatio` and `coefficientRestitution`, which the stiffness models do without:",
        "",
        "| model | values |",
        "|---|---|",
        *(f"| `{model}` | {_list(values)} |" for model, values in values_of_models().items()),
        "",
        "## What to use instead of what is refused",
        "",
        "The message for these words ends with it.",
        "",
        "| refused | instead |",
        "|---|---|",
        *(f"| `{word}` | {remedy} |" for word, remedy in sorted(names.REMEDIES.items())),
        *(f"| `{start}...` | {why} |" for start, why in names.OUT_OF_SCOPE),
        *(f"| contact model `{name}` | {why} |" for name, why in LACKING.items()),
        "",
        *_extensions(),
        _LIMITS,
    ]
    return "\n".join(lines).rstrip() + "\n"


def main(words: Sequence[str]) -> int:
    """Write the page to the named file, or to the screen; return the exit code."""
    if words:
        Path(words[0]).write_text(page(), encoding="utf-8")
    else:
        sys.stdout.write(page())
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
