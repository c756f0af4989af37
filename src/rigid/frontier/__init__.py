"""The natural-adversarial frontier: where to search, its shape, and how sure we are of it.

`largest_jump` chooses the λ to train at (paper, Alg. 1 and 2), `curve` turns measured points into
a curve and its areas, `statistics` turns several search seeds into numbers with intervals. All
three are pure functions of arrays. Nothing is re-exported here, since the function `largest_jump`
would hide the module of that name; users find the public functions in `rigid`.
"""
