"""What moves what: parameters one at a time around a baseline, and Sobol indices over ranges."""
