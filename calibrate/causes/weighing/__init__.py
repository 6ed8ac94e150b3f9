"""How probable the data are under many hypotheses that share their parameters.

All hypotheses are weighed on one cloud of draws of the parameters. What the base model expects is
computed once for each draw; what a cause adds is a polynomial in its strength there.
"""
