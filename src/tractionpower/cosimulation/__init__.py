"""From a scenario to results: checks, tables, blocks of steps, rows."""
