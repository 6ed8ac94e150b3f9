"""The heap: a slice between two side walls, or a free cone below a funnel."""
