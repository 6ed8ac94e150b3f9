"""What ``fix`` commands leave behind: plain objects that the engine turns into tables."""
