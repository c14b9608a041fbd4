"""Arithmetic that is written once, for one vehicle and for many.

A *block* is a slotted dataclass of floats, integers and booleans: the state of a part of one
vehicle.  A *kernel* is a plain function over blocks.  Called with blocks it runs in Python floats;
`lanes.batched(kernel)` runs the same source over numpy rows with one vehicle a column, and
`tools/compile_kernels.py` compiles it.  IEEE-754 makes + - * / sqrt and comparisons the same in
all three, so equal inputs give equal bytes, whatever the number of vehicles.

What a kernel may use: arithmetic, comparisons, `and`/`or`/`not`, `a if c else b` (a batch
evaluates both sides), `sqrt` of math, `float(x)`, `anywhere(c)`, other kernels, local names, and
attributes of blocks.  An `if` statement may only ask what is the same for every vehicle.
Integers are unsigned and 64 bits wide; mask what may overflow.  No `min`, `max`, `**`, `math` or
loops over vehicles.  No decorators: a compiled kernel would call what they make as Python does.
"""

from __future__ import annotations


def anywhere(condition: bool) -> bool:
    """Whether it holds for this vehicle; in a batch, for any of them."""
    return condition
