"""The workbooks of a sweep and of a comparison."""
