"""What all sheets stand on: cells and their styles, pages with tables, native charts, facts."""
