"""Names that LIGGGHTS-PUBLIC 3.8.0 documents: they tell a gap from a typing mistake."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from minidem.errors import suggest

__all__ = ["COMMANDS", "COMPUTES", "DUMPS", "FIXES", "LAMMPS", "OLD_MODELS", "foreign", "unknown"]


def _names(text: str) -> frozenset[str]:
    return frozenset(text.split())


COMMANDS: Final = _names(
    """
    angle_coeff angle_style atom_modify atom_style bond_coeff bond_style boundary box change_box
    clear communicate compute compute_modify create_atoms create_box delete_atoms delete_bonds
    dielectric dihedral_coeff dihedral_style dimension displace_atoms dump dump_modify echo fix
    fix_modify force_dt_reset group hard_particles if improper_coeff improper_style include info
    jump kspace_modify kspace_style label lattice log mass min_modify min_style minimize
    modify_timing neigh_modify neighbor newton next package pair_coeff pair_modify pair_style
    pair_write partition print processors quit read_data read_dump read_restart region replicate
    reset_timestep restart rotate run run_style run_time set shell soft_particles special_bonds
    suffix thermo thermo_log thermo_modify thermo_style timestep uncompute undump unfix units
    variable velocity write_data write_dump write_restart write_restart_on_signal
    """
)
"""Command words."""

FIXES: Final = _names(
    """
    adapt addforce ave/atom ave/correlate ave/euler ave/euler/stress ave/histo ave/spatial
    ave/time aveforce bond/break bond/create box/relax buoyancy check/timestep/gran concave
    contactproperty/atom contactproperty/atom/wall continuum/weighted couple/cfd
    couple/cfd/convection couple/cfd/convectiveImpl couple/cfd/dragforce couple/cfd/force
    couple/cfd/force/implicit couple/cfd/force/multisphere couple/cfd/radiation
    couple/cfd/speciesConvection couple/lb/onetoone
    custom_property/global deform deform/check diam/max drag dt/reset efield enforce2d external
    fiber/spring/simple freeze gravity heat/gran heat/gran/conduction insert/pack
    insert/rate/region insert/stream lineforce massflow/mesh massflow/mesh/sieve mesh/surface
    mesh/surface/planar mesh/surface/stress mesh/surface/stress/servo momentum move move/mesh
    move/mesh/file move/mesh/gran multicontact/halfspace multisphere multisphere/break
    multisphere/nointegration nve nve/asphere nve/asphere/noforce nve/limit nve/line nve/noforce
    nve/sph nve/sph/stationary nve/sphere nve/superquadric particledistribution/discrete
    particledistribution/discrete/massbased particledistribution/discrete/numberbased
    particletemplate/multiplespheres particletemplate/multisphere particletemplate/sphere
    particletemplate/superquadric planeforce poems print property/atom
    property/atom/regiontracer/time property/atom/timetracer property/atom/tracer
    property/atom/tracer/stream property/atomtypepair property/global region/variable rigid
    rigid/nph rigid/npt rigid/nve rigid/nvt rigid/small
    setforce sph/density/continuity sph/density/corr sph/density/summation sph/pressure spring
    spring/rg spring/self store/force store/state transportequation/scalar viscous wall/gran
    wall/reflect wall/region wall/region/sph wall/sph
    """
)
"""Fix styles."""

COMPUTES: Final = _names(
    """
    atom/molecule bond/local centro/atom cluster/atom cna/atom com com/molecule contact/atom
    contact/atom/gran coord/atom coord/gran displace/atom erotate erotate/asphere
    erotate/multisphere erotate/sphere erotate/sphere/atom erotate/superquadric group/group
    gyration gyration/molecule inertia/molecule ke ke/atom ke/multisphere msd msd/molecule
    msd/nongauss multisphere multisphere/single nparticles/tracer/region pair/gran/local pe
    pe/atom pressure property/atom property/local property/molecule rdf reduce reduce/region
    reduce/sph rigid slice stress/atom voronoi/atom wall/gran/local
    """
)
"""Compute styles."""

DUMPS: Final = _names(
    """
    atom atom/vtk cfg custom custom/vtk custom/vtm dcd decomposition/vtk euler/vtk image local
    local/gran/vtk mesh/gran/VTK mesh/stl mesh/vtk mesh/vtm movie stl xyz
    """
)
"""Dump styles."""

HARMLESS: Final = _names(
    """
    dump dump_modify echo group if info jump label log next print region run shell thermo thermo_log
    thermo_modify thermo_style undump variable velocity write_dump
    """
)
"""Commands between two runs that leave forces and lists as they are."""


REMEDIES: Final = {
    "mass": "LIGGGHTS refuses it for spheres as well; use set type N density RHO",
    "minimize": "let the particles come to rest with run and fix viscous",
    "spring/rg": "LIGGGHTS 3.8.0 breaks off as well; use spring/self",
    "enforce2d": "LIGGGHTS 3.8.0 refuses it in three dimensions as well; use planeforce 0 0 1",
    "efield": "spheres have no charge in LIGGGHTS 3.8.0 either; use addforce",
    "external": "it needs a program around the engine; use addforce with variables",
    "wall/reflect": "LIGGGHTS 3.8.0 has it in its manual only; use wall/gran or wall/region",
    "atom": "LIGGGHTS 3.8.0 has it in its manual only; use dump custom",
    "cfg": "LIGGGHTS 3.8.0 has it in its manual only; use dump custom",
    "dcd": "LIGGGHTS 3.8.0 has it in its manual only; use dump custom",
    "coord/gran": "LIGGGHTS 3.8.0 has it in its manual only; use contact/atom",
    "custom/vtm": "use dump custom/vtk",
    "mesh/vtm": "use dump mesh/vtk",
    "property/atom/timetracer": "its name in LIGGGHTS 3.8.0 is property/atom/regiontracer/time",
    "property/atomtypepair": "use property/global with peratomtypepair",
    "move/mesh/file": "use move/mesh with linear/variable or rotate/variable",
}
"""What to use instead of words that exist in LIGGGHTS only."""

_NO_HEAT = "heat is not computed; without it the motion is the same"
_NO_BONDS = "bonds between grains are not computed; cohesion is what minidem has that attracts"
_NO_CLUMPS = "clumps are not computed; use spheres with rolling friction"
_NO_SHAPES = "grains are spheres; use rolling friction for their shape"
_NO_FLUID = "neither a fluid nor a coupled program is computed; fix drag/sphere has air at rest"
_NO_SPH = "smoothed particle hydrodynamics is not computed"
OUT_OF_SCOPE: Final = (
    ("heat/", _NO_HEAT),
    ("bond", _NO_BONDS),
    ("delete_bonds", _NO_BONDS),
    ("multisphere", _NO_CLUMPS),
    ("particletemplate/multisphere", _NO_CLUMPS),
    ("rigid", _NO_CLUMPS),
    ("poems", _NO_CLUMPS),
    ("couple/", _NO_FLUID),
    ("sph", _NO_SPH),
    ("wall/region/sph", _NO_SPH),
    ("nve/superquadric", _NO_SHAPES),
    ("nve/asphere", _NO_SHAPES),
    ("nve/line", _NO_SHAPES),
    ("particletemplate/superquadric", _NO_SHAPES),
    ("erotate/multisphere", _NO_CLUMPS),
    ("erotate/superquadric", _NO_SHAPES),
    ("erotate/asphere", _NO_SHAPES),
    ("ke/multisphere", _NO_CLUMPS),
)
"""Beginnings of words for which there is no plan, and the reason."""


OLD_MODELS: Final = {
    "gran/hooke": "hooke tangential no_history",
    "gran/hooke/history": "hooke tangential history",
    "gran/hertz/history": "hertz tangential history",
}
"""Styles of pairs and walls of LAMMPS, which LIGGGHTS had once, and the model that they are now."""

_INSERT = (
    "use insert/pack, or insert/rate/region for grains that come in time, with "
    "particletemplate/sphere and particledistribution/discrete"
)
_SPATIAL = "use fix ave/spatial or ave/euler"
LAMMPS: Final = {
    ("command", "comm_modify"): "write 'communicate single vel yes'",
    ("command", "comm_style"): "leave it out",
    ("command", "balance"): "leave it out, there is one process",
    ("command", "timer"): "leave it out",
    ("fix", "balance"): "leave it out, there is one process",
    ("fix", "pour"): _INSERT,
    ("fix", "deposit"): _INSERT,
    ("fix", "evaporate"): "use delete_atoms between two runs",
    ("fix", "wall/gran/region"): "use wall/gran with a mesh, or with primitive",
    ("fix", "ave/chunk"): _SPATIAL,
    ("compute", "chunk/atom"): _SPATIAL,
    ("dump", "vtk"): "use custom/vtk",
    ("communicate", "mode"): "write 'communicate single vel yes'",
    ("group", "clear"): "write 'group ID delete'",
    ("group", "empty"): "write 'group ID initialize'",
    ("group", "include"): "make the group with region, type, id or variable",
    ("group", "static"): "leave it out, all groups are",
    ("group", "dynamic"): "make it anew between runs: group ID delete, group ID variable NAME",
    ("pair_style", "granular"): (
        "write 'pair_style gran model hertz tangential history', and the coefficients with fix "
        "property/global"
    ),
}
"""Words of today's LAMMPS, by kind, and what to write instead."""

_NEITHER: Final = "; LIGGGHTS 3.8.0 has none of that name either (a modified LIGGGHTS may)"
_OF_KIND: Final = {"command": COMMANDS, "fix": FIXES, "compute": COMPUTES, "dump": DUMPS}


def foreign(kind: str, word: str) -> str:
    """Return the message for a word of LAMMPS, '' for any other.

    Examples
    --------
    >>> foreign("group", "clear")
    "group 'clear' is one of LAMMPS that LIGGGHTS 3.8.0 does not have; write 'group ID delete'"
    >>> foreign("group", "region")
    ''
    """
    remedy = LAMMPS.get((kind, word))
    if not remedy:
        return ""
    return f"{kind} '{word}' is one of LAMMPS that LIGGGHTS 3.8.0 does not have; {remedy}"


def unknown(kind: str, word: str, known: Iterable[str]) -> str:
    """Return the message for a word that the engine does not know.

    Parameters
    ----------
    kind : str
        ``command``, ``fix``, ``compute``, ``dump`` or ``pair_style``.
    word : str
        The word.
    known : iterable of str
        Words that would be understood.

    Examples
    --------
    >>> unknown("command", "fxi", ["fix", "run"])
    "unknown command 'fxi'; did you mean 'fix'?"
    >>> unknown("fix", "concave", ["gravity"])
    "fix 'concave' exists in LIGGGHTS but not in minidem"
    >>> unknown("fix", "mcg", ["gravity"])
    "unknown fix 'mcg'; LIGGGHTS 3.8.0 has none of that name either (a modified LIGGGHTS may)"
    """
    if word in _OF_KIND.get(kind, ()):
        reasons = (why for start, why in OUT_OF_SCOPE if word.startswith(start))
        remedy = REMEDIES.get(word) or next(reasons, "")
        told = f"; {remedy}" if remedy else ""
        return f"{kind} '{word}' exists in LIGGGHTS but not in minidem{told}"
    if (kind, word) in LAMMPS:
        return foreign(kind, word)
    wall, _, model = word.partition("/")
    if (kind, wall) == ("fix", "wall") and model in OLD_MODELS:
        return (
            f"fix {word}: a name that LIGGGHTS 3.8.0 does not have either; write 'fix ID GROUP "
            f"wall/gran model {OLD_MODELS[model]} primitive type 1 zplane 0.0'"
        )
    near = suggest(word[:80], known)
    told = near or (_NEITHER if kind in _OF_KIND else "")
    return f"unknown {kind} '{word[:60]}'{told}"
