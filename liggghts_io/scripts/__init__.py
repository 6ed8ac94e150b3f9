"""From templates to LIGGGHTS scripts."""
