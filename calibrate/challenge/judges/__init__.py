"""What judges a study besides the diagnosis as it is, and what anybody could judge at best."""
