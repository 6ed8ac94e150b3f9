"""``delete_atoms STYLE ...``: particles that go."""

from __future__ import annotations

import numpy as np

from minidem.commands.atoms import selection
from minidem.commands.command import COMMANDS
from minidem.contact.near import pairs_within
from minidem.errors import InputError
from minidem.insertion.seeds import read_seed
from minidem.kernels.columns import POSITION
from minidem.run.engine import Engine
from minidem.run.renumbered import compress_ids, note_contacts
from minidem.run.spatial_order import neighbor_cutoff
from minidem.script.marsaglia import Marsaglia
from minidem.words import Words, one_of
from minidem.world.periodic import wrapped
from minidem.world.state import Ints
from minidem.world.world import World

_STYLES = ("group", "region", "overlap", "porosity")


@COMMANDS.register("delete_atoms")
def _delete_atoms(engine: Engine, words: Words) -> None:
    words.need(2, "delete_atoms group ID | region ID | overlap CUT G1 G2 | porosity REGION F SEED")
    world = engine.world
    style = words.choice(_STYLES, "style")
    if style == "overlap":
        who = _too_near(engine, words)
    elif style == "porosity":
        who = _thinned(world, words)
    else:
        who = selection(world, style, words.take("an ID"))
    compress = True
    while not words.done():
        if words.choice(("compress", "mol")) == "compress":
            compress = words.yes_no()
        else:
            words.yes_no()  # spheres belong to no molecule
    before = world.state.n
    _delete(world, who, compress=compress)
    world.log(f"Deleted {before - world.state.n} atoms, new total = {world.state.n}")


def _too_near(engine: Engine, words: Words) -> Ints:
    """Read distance and groups; return the particles that go so that no two are too near.

    They are gone through in the order of output. Across a periodic face the one with the smaller
    id goes.
    """
    words.need(3, "delete_atoms overlap CUT GROUP1 GROUP2")
    world = engine.world
    cut = words.positive()
    bits = [world.bit(words.take("a group")) for _ in range(2)]
    engine.report.screen("System init for delete_atoms ...")
    state, box = world.state, world.need_box()
    if world.pair.switches is None:
        msg = "Delete_atoms requires a pair style be defined"
        raise InputError(msg)
    reach = neighbor_cutoff(world)
    if cut > reach:
        msg = f"Delete_atoms cutoff > neighbor cutoff: {cut:g} m is above {reach:g} m"
        raise InputError(msg)
    state.row[: state.n, POSITION], turns = wrapped(box, state.row[: state.n, POSITION])
    state.image[: state.n] += turns
    points = state.row[: state.n, POSITION]
    one, other = pairs_within(points, cut, box)
    apart = points[one] - points[other]
    image = (apart * apart).sum(axis=1) >= cut * cut
    first, second = (world.member(bit) for bit in bits)
    wanted = first[one] & second[other]
    # beyond a periodic face: one of two that may both go is decided by their ids
    both = wanted & image & second[one] & first[other]
    wanted &= ~(both & (state.ids[one] > state.ids[other]))
    one, other, image = one[wanted], other[wanted], image[wanted]
    order = np.argsort(state.rank[one], kind="stable")
    gone = np.zeros(state.n, bool)
    for i, j, far in zip(one[order].tolist(), other[order].tolist(), image[order], strict=True):
        if not gone[i] and (far or not gone[j]):
            gone[i] = True
    return np.flatnonzero(gone)


def _thinned(world: World, words: Words) -> Ints:
    """Read region, fraction and seed; return the particles in the region that go by chance."""
    words.need(3, "delete_atoms porosity REGION FRACTION SEED")
    region = world.regions[one_of(words.take("a region"), tuple(world.regions), "region ID")]
    part, random = words.number(), Marsaglia(read_seed(words.take("a seed")))
    order = world.state.output_order()
    inside = region.match(world.state.row[order, POSITION])
    chosen = [i for i in order[inside].tolist() if random.uniform() <= part]
    return np.array(chosen, np.int64)


def _delete(world: World, who: Ints, *, compress: bool) -> None:
    """Delete particles; ids become 1..n again unless `compress` is False."""
    state, lists = world.state, world.lists
    keep = np.ones(state.n, bool)
    keep[who] = False
    noted = (lists.noted or note_contacts(world)) if compress else lists.noted
    order = np.flatnonzero(keep)
    if len(who):
        lists.keep_only(keep)
        state.drop_in_passes([~keep])
    state.take(order)
    if compress:
        noted = compress_ids(world, noted)
        if noted is not None:
            world.warn(
                "delete_atoms: particles get other ids, under which LIGGGHTS 3.8.0 does not find "
                "what contacts of particles with each other remember; most begin anew in the next "
                "run, as there; 'compress no' keeps ids and contacts"
            )
    lists.noted = noted
