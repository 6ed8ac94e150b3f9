"""Runs of many cases: workers, campaign, stored results."""
