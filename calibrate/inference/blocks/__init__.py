"""Problems of many materials: independent blocks, given what they have in common."""
