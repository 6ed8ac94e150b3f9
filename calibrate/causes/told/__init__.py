"""A diagnosis as sentences, record and figure."""
