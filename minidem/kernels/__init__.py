"""Hot loops: functions on scalars and arrays, compiled by Numba where it is there."""
