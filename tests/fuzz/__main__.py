"""The command line: ``python -m tests.fuzz --minutes N``."""

from __future__ import annotations

import argparse
import os
import resource
import sys
import tempfile
import time
from collections.abc import Iterator
from itertools import chain, islice
from random import Random

from tests.fuzz.campaign import Campaign, Found, Input, batches, hostile_inputs, mutated, save, table
from tests.fuzz.minimise import minimise, signature
from tests.fuzz.seeds import Files, of_cases, of_folder
from tests.fuzz.targets import TARGETS

_NAMES = [target.name for target in TARGETS]
_SECONDS_TO_MINIMISE = 60


def main() -> int:
    """Run a campaign, print its figures, and return whether it has failed."""
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description="Fuzz ros-lint.")
    parser.add_argument(
        "--minutes", type=float, default=1.0, help="how long, without the time to make failures smaller (default: 1)"
    )
    parser.add_argument("--seeds", action="append", default=[], metavar="FOLDER", help="also mutate the packages below a folder")
    parser.add_argument("--target", action="append", choices=_NAMES, help="only this target; may be repeated")
    parser.add_argument("--seed", type=int, default=0, help="seed of the random numbers; the same seed gives the same inputs")
    parser.add_argument("--hostile", choices=("first", "only", "none"), default="first", help="when to run the hostile seeds")
    parser.add_argument("--share", type=int, default=1, metavar="N", help="run every N-th hostile seed (default: all)")
    parser.add_argument("--save", default="fuzz-findings", metavar="FOLDER", help="where to write inputs that fail")
    options = parser.parse_args()
    started = time.monotonic()
    random = Random(options.seed)
    targets = options.target or _NAMES
    seeds = [*of_cases(), *chain.from_iterable(map(of_folder, options.seeds))]
    parts: list[Iterator[Input]] = []
    if options.hostile != "none":
        parts.append(islice(hostile_inputs(random, targets), 0, None, options.share))
    if options.hostile != "only":
        parts.append(mutated(random, seeds, targets))
    causes: dict[str, int] = {}
    with tempfile.TemporaryDirectory() as folder:
        campaign = Campaign(os.path.join(folder, "inputs"))
        lost = 0.0
        for batch in batches(chain.from_iterable(parts)):
            campaign.run(batch)
            before = time.monotonic()
            for found in campaign.found:
                cause = signature(found.failure)
                causes[cause] = causes.get(cause, 0) + 1
                if causes[cause] == 1:
                    _report(found, campaign, options.save)
            campaign.found.clear()
            lost += time.monotonic() - before
            if time.monotonic() - started - lost > options.minutes * 60:
                break
        campaign.close()
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(table(campaign.rows))
    print(
        f"\n{time.monotonic() - started:.0f} s, of which {used.ru_utime + used.ru_stime:.0f} s of processor time in the servers"
    )
    for cause, count in sorted(causes.items(), key=lambda item: -item[1]):
        print(f"{count} x {cause}")
    return bool(causes)


def _report(found: Found, campaign: Campaign, folder: str) -> None:
    """Make an input smaller, save it, and print its failure."""
    cause = signature(found.failure)
    rows, campaign.rows = campaign.rows, {}

    def fails(files: Files) -> bool:
        campaign.found.clear()
        campaign.run([found.input._replace(files=files)])
        return any(signature(other.failure) == cause for other in campaign.found)

    kept = list(campaign.found)
    costly = found.failure.startswith(("slow", "hangs", "memory"))
    smaller = found.input.files if costly else minimise(found.input.files, fails, _SECONDS_TO_MINIMISE)
    campaign.found[:] = kept
    campaign.rows = rows
    place = save(Found(found.input._replace(files=smaller), found.failure), folder)
    print(f"FAILED {found.input.target}, {found.input.name}: {place}\n{found.failure[-1500:]}\n", flush=True)


if __name__ == "__main__":
    sys.exit(main())
