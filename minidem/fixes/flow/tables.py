"""Counters of particles through meshes as the kernels have them, and what kernels give back."""

from __future__ import annotations

import numpy as np

from minidem.fixes.flow.massflow import MassFlow
from minidem.fixes.motions import moving_meshes
from minidem.kernels.columns import (
    EVENT_FLOW,
    FLOW,
    FLOW_DELETE,
    FLOW_GROUP,
    FLOW_NORMAL,
    FLOW_ONCE,
    FLOW_OUTLET,
    FLOW_POINT,
    FLOW_TRIANGLE,
    FLOW_VALUE,
    MASS,
    ONLY,
    RANGE,
    UNSEEN,
    A,
    three,
)
from minidem.kernels.tables import Flows
from minidem.world.state import Floats, Ints
from minidem.world.world import World

__all__ = ["counters_delete", "drain", "place_counters", "prepare_flows", "take_out"]


def _ranges(world: World) -> Ints:
    """Return triangle range and motion of every flow mesh, shape (flows, 3)."""
    flows = world.of_kind(MassFlow)
    moving = moving_meshes(world) if flows else []
    rows = [(*world.meshes.span(flow.mesh), int(flow.mesh in moving)) for flow in flows]
    return np.array(rows, np.int64).reshape(-1, RANGE)


def _tables(world: World) -> tuple[Ints, Floats]:
    """Return the tables of flow counters, see `minidem.kernels.tables.Flows`."""
    flows = world.of_kind(MassFlow)
    spec = np.zeros((len(flows), FLOW), np.int64)
    value = np.zeros((len(flows), FLOW_VALUE))
    for i, flow in enumerate(flows):
        lo, _ = world.meshes.span(flow.mesh)
        normal = world.meshes.table.normal[lo]
        spec[i, FLOW_ONCE] = flow.once
        spec[i, FLOW_GROUP] = flow.bit
        spec[i, FLOW_TRIANGLE] = lo
        spec[i, FLOW_DELETE] = flow.delete
        if flow.outlet is not None:
            spec[i, FLOW_OUTLET] = -1 if flow.inside_out else 1
            value[i, three(FLOW_POINT)] = flow.outlet
            continue
        value[i, three(FLOW_POINT)] = world.meshes.table.node[lo, A]
        value[i, three(FLOW_NORMAL)] = normal if float(normal @ flow.side) >= 0.0 else -normal
    return spec, value


def prepare_flows(world: World) -> None:
    """Set up the counters for a run; markers of counters that stay are kept."""
    names = tuple(flow.name for flow in world.of_kind(MassFlow))
    state = world.state
    if names != world.flows:
        marker = np.full((len(names), state.cap), UNSEEN, np.int8)
        for i, name in enumerate(names):
            if name in world.flows:
                marker[i] = state.marker[world.flows.index(name)]
        state.marker = marker
        world.flows = names
    world.lists.set_flows(state, *_tables(world))
    place_counters(world)


def place_counters(world: World) -> None:
    """Tell the kernels which triangles count passages, also when meshes have other images."""
    ranges = _ranges(world)
    if not np.array_equal(ranges, world.state.more.ranges):
        world.state.more = world.state.more._replace(ranges=ranges)


def drain(world: World, flows: Flows) -> None:
    """Book all passages noted since the last call."""
    count = int(flows.found[ONLY])
    flows.found[ONLY] = 0
    if count:
        counters = world.of_kind(MassFlow)
        for event in flows.event[:count].tolist():
            counters[int(event[EVENT_FLOW])].book(world, event)


def counters_delete(world: World) -> bool:
    """Return True if a counter takes particles out, which kernels cannot do."""
    return any(flow.delete for flow in world.of_kind(MassFlow))


def take_out(world: World) -> None:
    """Let the particles go that a counter deletes, when lists are made anew."""
    state = world.state
    for flow in world.of_kind(MassFlow):
        if not flow.doomed:
            continue
        place = {int(number): at for at, number in enumerate(state.ids[: state.n])}
        gone = [place[number] for number in flow.doomed if state.more.alive[place[number]]]
        flow.deleted_number += len(gone)
        flow.deleted_mass += float(state.row[gone, MASS].sum())
        state.more.alive[gone] = 0
        state.drop_ranks(gone)
        flow.doomed.clear()
