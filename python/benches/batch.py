"""Cost of calls and batches beside the same batches in Rust.

    pip install ./python && python python/benches/batch.py

Runs ``cargo bench --bench batch`` for the figures of Rust. Ratios below 1.2 from 10⁴ points on, and
a call with one number below 2 µs, are what is wanted.
"""

import subprocess
import timeit
from pathlib import Path

import pycognate as cg
import numpy as np

TEXTS = ["SIN(2*PI*TIME)*EXP(-0.3*TIME)+0.5*TIME**2-TIME**3", "STEP5(TIME, 0, 0, 1, 10)*SIN(2*PI*TIME)"]


def least(call, times):
    """Time of a call, the least of many [s]."""
    return min(timeit.repeat(call, number=1, repeat=times))


for text in TEXTS:
    f = cg.expr(text)
    rust = subprocess.run(
        ["cargo", "bench", "--quiet", "--bench", "batch", "--", text],
        cwd=Path(__file__).parents[1], capture_output=True, text=True, check=True,
    )
    figures = [line.split() for line in rust.stdout.splitlines()]
    print(text)
    print(f"  one call {1e6 * min(timeit.repeat(lambda: f(0.25), number=10000, repeat=20)) / 1e4:.3f} µs")
    for n, figure in figures:
        times = np.arange(int(n)) / int(n)
        own = 1e9 * least(lambda: f(times), max(20, min(2000, 30_000_000 // int(n)))) / int(n)
        print(f"  {n:>8} points  Python {own:7.3f}  Rust {float(figure):7.3f} ns a point  ratio {own / float(figure):.3f}")
