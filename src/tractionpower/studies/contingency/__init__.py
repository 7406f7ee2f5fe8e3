"""Outages one by one, and in pairs: what becomes of voltages, devices and trains."""
