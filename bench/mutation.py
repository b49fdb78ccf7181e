"""Mutation: how many small faults of the core the benches find.

Usage: ``python bench/mutation.py [--write] [--mutants N] [--minutes M] [GROUP ...]``. ``--write``
writes ``bench/results/mutation.md`` too. Needs the packages of ``make .venv/.hardware``.

Each mutant (bench/mutants.py) meets the bench of its module until the first failure. What survives meets a larger
bench, then a proof that it changes nothing. What was found is in ``build/mutation``: a campaign that was interrupted
goes on, and after a change of the benches only survivors meet them again.
"""

from __future__ import annotations

import hashlib
import json
import math
import os
import re
import resource
import shutil
import subprocess
import sys
import time
from collections import Counter
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING

from mutants import FOLDER, GROUPS, REPEATED, Mutant, compile_bench, make_mutants, run_yosys, shares, wrapper
from report import ROOT, options_of, publish, table
from run import SEED, get_results, prepare

sys.path.insert(0, str(ROOT / "rtl" / "formal"))
import prove

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from run import Build

BENCHES, PROOFS = ROOT / "rtl" / "benches", ROOT / "rtl" / "formal"
MUTANTS = 1000
PATIENCE = 3  # A bench that takes so many times the processor time that it takes without a fault has found it.
KILLED = ("own bench", "larger bench", "proof")
ALIVE, EQUIVALENT, NOT_MET = "alive", "equivalent", "not met"
CREDITS = "an assertion on credits, which the netlist lacks, finds this fault in the sources"
# Survivors that were looked at: group, place, fault without its wire; why no bench finds it.
REASONS = {
    "ray_setup-shared common/voxrt_collect.sv:31 const0 at A[1]": (
        "the results are loaded at a turn before, too; what counts is the last load of a beat"
    ),
    "serial_ray_setup rays/voxrt_serial_ray_setup.sv:127 inv at A[13]": "the distance of turns without an axis; unread",
    "serial_shader shading/voxrt_serial_shader.sv:193 cnot1 at Q[8]": (
        "bit 8 of a divisor of 42 bits, where another bit is set: a quotient of 8 bits rounds alike but for few"
    ),
    "serial_shader shading/voxrt_serial_shader.sv:179 cnot1 at A[13]": (
        "bit 13 of a product of 48 bits, where another bit is set: a quotient of 8 bits rounds alike but for few"
    ),
    "light_direction shading/voxrt_light_direction.sv:42 cnot1 at Y[4]": (
        "needs a hit point beyond the world: the side less a place is never negative"
    ),
    "hit_point lane/voxrt_hit_point.sv:131 cnot1 at Y[2]": (
        "the count goes through as many values in another order: 7, 6, 5, 4, 3, 2 become 3, 6, 5, 4, 7, 2"
    ),
    "hit_point lane/voxrt_hit_point.sv:125 cnot1 at D[5]": "needs a place beyond the world: bit 10 of it",
    "private_memory memory/voxrt_private_memory.sv:39 cnot0 at Q[3]": (
        "the turns of lanes alternate in another rhythm, and none starves"
    ),
    "private_memory memory/voxrt_private_memory.sv:87 const1 at Y[0]": (
        "the memory reads where nobody asks: power alone"
    ),
    "banked_memory common/voxrt_block_ram.sv:41 const1 at EN[0]": ("the memory reads where nobody asks: power alone"),
    "banked_memory memory/voxrt_banked_memory.sv:115 const1 at A[0]": (
        "which of the lanes that want a bank goes first; the other asks again"
    ),
    "banked_memory memory/voxrt_banked_memory.sv:121 inv at Q[0]": (
        "which of the lanes that want a bank goes first; the other asks again"
    ),
    "ray_setup rays/voxrt_ray_setup.sv:321 inv at B[0]": "whether a plane is ahead counts on dead axes alone",
    "registers generated/voxrt_registers.sv:1785 const1 at Q[0]": (
        "the material table answers as soon as any register: nothing overtakes it"
    ),
    "registers generated/voxrt_registers.sv:795 const0 at A[0]": "a pulse is 0 again before the next write",
    "registers generated/voxrt_registers.sv:977 const0 at B[0]": "the flag of a bus, which this core does not have",
    "lane lane/voxrt_next_cell.sv:79 const1 at Y[0]": "decides on dead axes alone, by which no ray leaves a cell",
    "lane lane/voxrt_slot_scheduler.sv:239 cnot1 at B[34]": (
        "needs bit 10 of a count of planes, which is at most 64 in this lane"
    ),
    "cached_memory memory/voxrt_l2_cache.sv:98 const1 at RD_DATA[13]": (
        "the number of a line on its way to the lanes, of which only the set is read"
    ),
    "cached_memory memory/voxrt_cached_memory.sv:61 const1 at A[0]": (
        "whether caches were emptied at the clock of a reset, after which no frame waits for that"
    ),
    "cached_memory memory/voxrt_l1_cache.sv:79 cnot1 at Y[2]": "the walk visits the sets as often, in another order",
    "cached_memory memory/voxrt_l1_cache.sv:181 inv at B[0]": "the walk visits the sets as often, in another order",
    "cached_memory memory/voxrt_l1_cache.sv:247 const1 at Y[0]": (
        "the L2 is not idle until the line has left it; the walk through the sets takes longer than the rest of its way"
    ),
    "core lane/voxrt_buffered_lane.sv:124 inv at Y[0]": CREDITS,
    "core lane/voxrt_buffered_lane.sv:126 const1 at D[3]": CREDITS,
    "core rays/voxrt_counters.sv:30 const0 at Y[25]": "bit 25 of a count of hits: needs a frame of so many",
    "core rays/voxrt_counters.sv:29 const0 at A[30]": "bit 30 of a count of pixels: needs a frame of so many",
    "core rays/voxrt_counters.sv:27 const0 at Q[16]": "bit 16 of the count of clocks: needs a frame of 65,536",
    "core voxrt_core.sv:235 cnot0 at A[3]": "inverts one write enable where another is low: no word is written anyway",
    "plane_time common/voxrt_plane_time.sv:68 inv at WR_EN[51]": "bit 56 of a time of 55 bits; unread",
    "brightness shading/voxrt_brightness.sv:149 inv at Y[2]": (
        "bit 2 of a product of 50 bits, which a brightness of 8 bits shows for few"
    ),
}


def run_bench(runner: object, build: Build, folder: Path, mutant: int, seconds: int | None = None) -> bool:
    """Run a bench with one mutant until its first failure; tell whether all of it passed."""
    os.environ["SIM_CMD_PREFIX"] = f"prlimit --cpu={seconds}" if seconds else ""
    results = folder / "bench" / "results.xml"
    results.unlink(missing_ok=True)
    try:
        runner.test(
            hdl_toplevel=build.top,
            test_module=",".join(build.benches),
            build_dir=folder / "bench",
            results_xml=str(results),
            seed=SEED,
            extra_env={"EDITED_FRAMES": str(build.edited_frames), "COCOTB_MAX_FAILURES": "1"},
            test_args=["+verilator+rand+reset+2", f"+verilator+seed+{SEED}"],
            plusargs=[f"+mutant={mutant}"],
            log_file=folder / "bench.txt",
        )
    except RuntimeError:  # It ended by a signal: the limit of processor time.
        return False
    return results.exists() and get_results(results)[1] == 0


@dataclass
class Campaign:
    """A group's mutants and what was found about them, in a file that grows with each mutant."""

    name: str
    mutants: list[Mutant]
    deadline: float = math.inf  # of time.monotonic(): no more benches and proofs after it

    def __post_init__(self) -> None:
        self.one = GROUPS[self.name]
        self.folder = FOLDER / self.name
        self.page = self.folder / "found.json"
        self.netlist = digest([self.folder / "netlist.v", self.folder / "mutants.ys"])
        self.benches = digest(sorted([*BENCHES.glob("*.py"), *PROOFS.iterdir()]))
        found = json.loads(self.page.read_text()) if self.page.exists() else {}
        same = found.get("netlist") == self.netlist
        self.verdicts: dict[str, str] = found["verdicts"] if same else {}
        self.unproven: list[int] = found["unproven"] if same else []
        self.survived: str = found["survived"] if same else ""  # The benches that all survivors met.

    def open_mutants(self) -> list[Mutant]:
        """Give those that nothing is known of, and those that survived other benches."""
        closed = {EQUIVALENT, *KILLED} | ({ALIVE} if self.survived == self.benches else set())
        return [mutant for mutant in self.mutants if self.verdicts.get(str(mutant.number)) not in closed]

    def note(self, mutant: Mutant, verdict: str) -> None:
        """Keep what became of a mutant."""
        self.verdicts[str(mutant.number)] = verdict
        self.save()

    def save(self) -> None:
        """Keep all that was found."""
        names = ("netlist", "survived", "unproven", "verdicts")
        content = dict(zip(names, (self.netlist, self.survived, self.unproven, self.verdicts), strict=True))
        self.page.write_text(json.dumps(content))

    def run(self) -> None:
        """Meet the mutants that nothing is known of with all that could find them."""
        survivors = self.open_mutants() if self.has_time() else []
        if survivors and self.one.proof:
            survivors = self.meet_proof(survivors)
        if survivors and self.one.build.benches:
            survivors = self.meet_bench(self.one.build, "own bench", survivors)
        if survivors and self.one.larger and self.has_time():
            survivors = self.meet_bench(self.one.larger, "larger bench", survivors)
        for mutant in survivors:
            self.note(mutant, EQUIVALENT if self.has_time() and self.is_equivalent(mutant) else ALIVE)
        if self.has_time():
            self.survived = self.benches
            self.save()

    def has_time(self) -> bool:
        """Tell whether the deadline is to come."""
        return time.monotonic() < self.deadline

    def is_equivalent(self, mutant: Mutant) -> bool:
        """Try to prove, by induction over a few clocks with the signals of both side by side, that no output differs.

        Signals that differ are taken for free in the next attempt.
        """
        if mutant.number in self.unproven:
            return False
        top, place = self.one.build.top, self.folder.relative_to(ROOT)
        free = self.folder / "free.txt"
        free.write_text("")
        script = (
            f"read_rtlil {place}/design.il; copy {top} gate; rename {top} gold; "
            f"{mutant.command.replace(f'-module {top} ', '-module gate ')}; bwmuxmap; memory_map; opt_clean; "
            f"equiv_make -blacklist {place}/free.txt gold gate equiv; hierarchy -top equiv; opt_merge -share_all; "
            "opt_clean; equiv_simple -seq 3; equiv_induct -seq 3; equiv_status -assert"
        )
        with suppress(subprocess.TimeoutExpired):
            for seconds in (20, 30):
                finished = run_yosys(script, timeout=seconds)
                if finished.returncode == 0:
                    return True
                differing = re.findall(r"Unproven \$equiv \S+: \\?(\S+)_gold", finished.stdout)
                free.write_text("".join(f"{name}\n" for name in [*free.read_text().split(), *differing]))
        self.unproven.append(mutant.number)
        return False

    def meet_proof(self, mutants: Sequence[Mutant]) -> list[Mutant]:
        """Prove the properties of the module with each of the mutants; give those with which they hold."""
        top = self.one.build.top
        changed, survivors = self.folder / f"{top}.sv", []
        for mutant in [None, *mutants]:
            if not self.has_time():
                break
            number = mutant.number if mutant else 0
            changed.write_text(wrapper(self.one, number) + (self.folder / "netlist.v").read_text())
            holds = all(prove.run(top, *job, changed) for job in (prove.PROOFS[top], ("cover", prove.COVERED)))
            if mutant is None:
                if not holds:
                    sys.exit(f"{self.name}: the proof fails without a fault")
            elif holds:
                survivors.append(mutant)
                print(f"{self.name} {number} survives: {mutant.place} {mutant.fault}", flush=True)
            else:
                self.note(mutant, "proof")
        return survivors

    def meet_bench(self, build: Build, verdict: str, mutants: Sequence[Mutant]) -> list[Mutant]:
        """Run a bench with each of the mutants; give those that it does not find."""
        folder = self.folder / verdict.replace(" ", "_")
        runner = compile_bench(build, self.one, folder, self.folder / "netlist.v")
        start = processor_time()
        if not run_bench(runner, build, folder, 0):
            sys.exit(f"{self.name}: the benches fail without a fault; see {folder / 'bench.txt'}")
        limit = 2 + int(PATIENCE * (processor_time() - start))
        survivors = []
        for number, mutant in enumerate(mutants):
            if not self.has_time():
                # Those that met another bench survived it; of the others nothing is known.
                return survivors + list(mutants[number:] if verdict == "larger bench" else ())
            if run_bench(runner, build, folder, mutant.number, limit):
                survivors.append(mutant)
                self.note(mutant, ALIVE)  # until something else finds it, were the campaign interrupted
                print(f"{self.name} {mutant.number} survives: {mutant.place} {mutant.fault}", flush=True)
            else:
                self.note(mutant, verdict)
        return survivors


def processor_time() -> float:
    """Give the seconds that ended child processes have taken."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def digest(paths: Sequence[Path]) -> str:
    return hashlib.sha256(b"\0".join(path.read_bytes() for path in paths if path.is_file())).hexdigest()


def page(campaigns: Sequence[Campaign]) -> str:
    """Give the page: a row per group, and the mutants that live."""
    counted = {
        each.name: Counter(each.verdicts.get(str(mutant.number), NOT_MET) for mutant in each.mutants)
        for each in campaigns
    }
    total = sum(counted.values(), Counter())
    rows = [
        [name, ", ".join(file.removeprefix("voxrt_") for file in GROUPS[name].files), *numbers_of(counts)]
        for name, counts in counted.items()
    ]
    rows.append(["**all**", "", *(f"**{number}**" for number in numbers_of(total))])
    # A group that was interrupted says nothing: what is found ends soon, and what survives takes longest.
    whole = sum((counts for counts in counted.values() if not counts[NOT_MET]), Counter())
    killed, faults = sum(whole[verdict] for verdict in KILLED), sum(whole.values()) - whole[EQUIVALENT]
    living = [
        [each.name, mutant.place, mutant.fault, reason_of(each, mutant)]
        for each in campaigns
        for mutant in each.mutants
        if each.verdicts.get(str(mutant.number)) == ALIVE
    ]
    return (
        "# How good the tests of the RTL are\n\nMade by `python bench/mutation.py --write`.\n\n"
        f"{sum(total.values())} mutants: faults of one bit at one port of one cell, which yosys `mutate` chose evenly. "
        f"Mutants are distributed by the places in the sources that cells come from; of generated registers one place "
        f"in {REPEATED} counts. In the groups of which all were met, {whole[EQUIVALENT]} change nothing, by a proof of "
        f"equivalence; of the other {faults}, {killed} are found: **{killed / max(faults, 1):.1%}**."
        + (f" **{total[NOT_MET]} were not met yet**: the campaign goes on where it stopped." if total[NOT_MET] else "")
        + "\n\n"
        + table(["group", "files", "mutants", *KILLED, EQUIVALENT, ALIVE, NOT_MET], rows, left=2)
        + "\n## What survives\n\n"
        + table(["group", "place", "fault", "why no bench finds it"], living)
    )


def reason_of(campaign: Campaign, mutant: Mutant) -> str:
    """Give why nothing finds a mutant; the name of its wire does not count."""
    fault = f"{campaign.name} {mutant.place} {mutant.fault}".partition(" of ")[0]
    return REASONS.get(fault, "not explained yet")


def numbers_of(counts: Counter[str]) -> list[str]:
    return [str(sum(counts.values())), *(str(counts[verdict]) for verdict in (*KILLED, EQUIVALENT, ALIVE, NOT_MET))]


def main() -> None:
    parser = options_of(__doc__)
    parser.add_argument("names", nargs="*", metavar="GROUP", help="all, if none is named; only all make the page")
    parser.add_argument("--mutants", type=int, default=MUTANTS, help="how many, of all groups together")
    parser.add_argument("--minutes", type=float, default=math.inf, help="begin no bench and no proof after so many")
    options = parser.parse_args()
    deadline = time.monotonic() + 60 * options.minutes
    if unknown := [name for name in options.names if name not in GROUPS]:
        parser.error(f"there is no group {', '.join(unknown)}; there are {', '.join(GROUPS)}")
    prepare()
    os.environ.setdefault("OBJCACHE", shutil.which("ccache") or "")
    counts = shares(options.mutants)
    campaigns = []
    for name in options.names or GROUPS:
        start = time.monotonic()
        campaigns.append(Campaign(name, make_mutants(GROUPS[name], counts[name], FOLDER / name), deadline))
        campaigns[-1].run()
        verdicts = ", ".join(
            f"{count} {verdict}" for verdict, count in Counter(campaigns[-1].verdicts.values()).items()
        )
        print(f"{name}: {verdicts}, {time.monotonic() - start:.0f} s", flush=True)
    if not options.names:
        publish("mutation.md", page(campaigns), write=options.write)


if __name__ == "__main__":
    main()
