"""Forces from script variables: worked out in Python once per step."""

from __future__ import annotations

from minidem.fixes.simple import Post
from minidem.kernels.tables import Posts
from minidem.world import World

__all__ = ["fill_posts"]


def fill_posts(world: World, posts: Posts | None) -> Posts:
    """Evaluate the variables of body forces now.

    Raises
    ------
    ValueError
        If a force variable is used before the run was prepared.
    """
    if posts is None:
        msg = "the run was not prepared"
        raise ValueError(msg)
    for p, post in enumerate(world.of_kind(Post)):
        for c, name in enumerate(post.variables):
            if name is not None:
                posts.value[p, c] = world.interpreter.value(name)
    return posts
