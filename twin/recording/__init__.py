"""A voyage: files in, checked, files out. One reader a format, all ending in one table."""
