"""From a study and its runs to a diagnosis, a check by the engine and an extended study."""
