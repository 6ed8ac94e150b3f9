"""The paper's tables and figures beside ours; `python -m benchmarks.paper` writes docs/paper.md."""
