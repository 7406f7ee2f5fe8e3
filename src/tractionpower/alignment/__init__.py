"""Tracks and routes as arrays: kilometres, metres, and what lies where."""
