"""What happens to campaigns while they run: kills, signals, stops, company."""

from __future__ import annotations

import os
import random
import signal
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field

from tests.torture.arena import Arena, Ended, Running

STOP_S = (1.5, 2.5)
"""Longer than anybody waits for a lock without saying so."""
START_S = 60.0
"""So long a campaign may need until its first engine starts."""
WITHIN_S = 0.4
"""Accidents happen within that time after an engine has started."""
INTERRUPTS = {signal.SIGINT: 130, signal.SIGTERM: 143}
CONTINUE = "Continue with:"


@dataclass
class Accidents:
    """What was done in one round.

    Attributes
    ----------
    count : int
        Incidents.
    lost : int
        Runs that may be under way a second time because of them.
    faults : list of str
        What a campaign did wrong already while it was disturbed.
    ended : list of Ended
        Campaigns that came to their end in spite of it.
    """

    count: int = 0
    lost: int = 0
    faults: list[str] = field(default_factory=list)
    ended: list[Ended] = field(default_factory=list)

    def __iadd__(self, other: Accidents) -> Accidents:
        """Add what was done next."""
        self.count += other.count
        self.lost += other.lost
        self.faults += other.faults
        self.ended += other.ended
        return self


def at_random(arena: Arena, running: Running, draw: random.Random) -> None:
    """Wait until an engine has started, and then a random time; sometimes not even so long."""
    before = arena.starts()
    if draw.random() < 0.2:
        time.sleep(draw.uniform(0.0, 2.0))
        return
    arena.wait(lambda: arena.starts() > before or running.process.poll() is not None, START_S)
    time.sleep(draw.uniform(0.0, WITHIN_S))


def kill_campaign(arena: Arena, draw: random.Random, times: int) -> Accidents:
    """Kill the campaign itself; its workers and engines have to end by themselves."""
    done = Accidents()
    for _ in range(times):
        running = arena.start()
        at_random(arena, running, draw)
        done.count += running.send(signal.SIGKILL)
        running.ended()
        done.lost += arena.workers
        if arena.orphans():
            done.faults.append(f"processes outlived the campaign: {arena.orphans()}")
    return done


def _kill_some(kind: str) -> Callable[[Arena, random.Random, int], Accidents]:
    def kill(arena: Arena, draw: random.Random, times: int) -> Accidents:
        done = Accidents()
        running = arena.start()
        for _ in range(times):
            at_random(arena, running, draw)
            victims = arena.processes(kind)
            if victims:
                with suppress(ProcessLookupError):
                    os.kill(draw.choice(victims), signal.SIGKILL)
                done.count += 1
                done.lost += 1
        ended = running.ended()
        if ended.table is None:
            done.faults.append(f"the campaign did not go on: {ended.code} {ended.said}")
        return done

    return kill


kill_worker = _kill_some("worker")
kill_engine = _kill_some("engine")


def interrupt(arena: Arena, draw: random.Random, times: int) -> Accidents:
    """Send Ctrl-C or SIGTERM; the campaign says how to continue, with the exit code for it."""
    done = Accidents()
    for _ in range(times):
        running = arena.start()
        at_random(arena, running, draw)
        number, busy, before = draw.choice(list(INTERRUPTS)), arena.busy(), arena.starts()
        done.count += running.send(number)
        ended = running.ended()
        done.lost += arena.workers
        # Before its first line the program is Python that imports, and answers as that does.
        early = ended.code == -number and arena.starts() == before
        told = ended.code == INTERRUPTS[number] and CONTINUE in ended.said
        if not (told or early or (ended.code == 0 and not busy)):
            done.faults.append(f"{number.name}: exit {ended.code}, said {ended.said[-300:]}")
        if arena.orphans():
            done.faults.append(f"processes outlived {number.name}: {arena.orphans()}")
    return done


def stop_and_continue(arena: Arena, draw: random.Random, times: int) -> Accidents:
    """Stop processes for longer than a lock's patience while a second campaign comes."""
    done = Accidents()
    for _ in range(times):
        running = arena.start()
        at_random(arena, running, draw)
        victims = arena.processes(draw.choice(["campaign", "worker", "engine", ""]))
        for pid in victims:
            with suppress(ProcessLookupError):
                os.kill(pid, signal.SIGSTOP)
        second = arena.start() if draw.random() < 0.5 else None
        time.sleep(draw.uniform(*STOP_S))
        for pid in victims:
            with suppress(ProcessLookupError):
                os.kill(pid, signal.SIGCONT)
        done.count += 1
        done.ended += [one.ended() for one in (running, second) if one is not None]
    return done


def _together(many: int) -> Callable[[Arena, random.Random, int], Accidents]:
    def run(arena: Arena, draw: random.Random, times: int) -> Accidents:
        del times  # a second round would find everything done
        running = []
        for _ in range(many):
            running.append(arena.start())
            time.sleep(draw.uniform(0.0, 1.0))
        return Accidents(count=1, ended=[one.ended() for one in running])

    return run


two_campaigns, four_campaigns = _together(2), _together(4)

ACCIDENTS: Mapping[str, Callable[[Arena, random.Random, int], Accidents]] = {
    "kill -9 of the campaign": kill_campaign,
    "kill -9 of a worker": kill_worker,
    "kill -9 of LIGGGHTS": kill_engine,
    "SIGINT or SIGTERM": interrupt,
    "SIGSTOP, then SIGCONT": stop_and_continue,
    "two campaigns at once": two_campaigns,
    "four campaigns at once": four_campaigns,
}
