"""Results: columns with units, tables on disk, key figures, ledgers."""
