"""What every device carries, held against what it can bear."""
