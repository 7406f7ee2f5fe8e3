"""Importers: files of other formats to files of a study, with a word on all that was read, assumed, repaired, ignored."""
