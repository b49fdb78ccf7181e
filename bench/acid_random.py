"""Random meshes: voxrt against the checker in fractions, by each rule.

Usage: ``python bench/acid_random.py [--meshes 2000] [--seed 1]``. Depths are 1 to 6. About a second per mesh. Prints
how many were compared, and the smallest mesh of those that differ. ``acid/comparison.py`` makes them.
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from typing import TYPE_CHECKING

from acid.checker import bodies
from acid.comparison import expected, solids, voxels_of
from hypothesis import HealthCheck, Phase, given, seed, settings

if TYPE_CHECKING:
    from acid.checker import Triangle


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--meshes", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    depths: Counter[int] = Counter()
    pieces: Counter[int] = Counter()
    rules: Counter[str] = Counter()
    differences: list[tuple[int, str, list[Triangle], int]] = []

    @seed(options.seed)
    @settings(
        max_examples=options.meshes,
        deadline=None,
        database=None,
        phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
    )
    @given(solids(depths=(1, 6)))
    def compare(solid: tuple[list[Triangle], int]) -> None:
        triangles, depth = solid
        depths[depth] += 1
        pieces[len(bodies(triangles))] += 1
        for rule, voxels in expected(triangles, depth).items():
            rules[rule] += 1
            if voxels_of(triangles, depth, rule=rule) != voxels:
                differences.append((len(triangles), rule, triangles, depth))
        if depths.total() % 100 == 0:
            print(f"{depths.total()} meshes, {len(differences)} differences", file=sys.stderr)

    compare()
    print(f"{depths.total()} meshes, seed {options.seed}; {len(differences)} differences")
    for name, counts in (("depth", depths), ("bodies", pieces), ("rule", rules)):
        print(f"{name}: " + ", ".join(f"{key} {count}" for key, count in sorted(counts.items())))
    if differences:
        _, rule, triangles, depth = min(differences)
        print(f"{rule} at depth {depth}, corners in 1/4096 voxel: {triangles}")
    return bool(differences)


if __name__ == "__main__":
    sys.exit(main())
