"""From emulators and measured values to what is known of the unknowns."""
