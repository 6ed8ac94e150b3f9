"""The run of a script: engine, loop, restart files, threads."""
