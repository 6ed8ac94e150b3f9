"""Verbs that look at what a run left: post and render."""
