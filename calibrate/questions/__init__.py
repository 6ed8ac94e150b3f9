"""What is asked of the core: one problem per study, and calibration, prediction, determination."""
