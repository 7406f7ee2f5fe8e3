"""The search for the least equipment that meets the limits, in normal operation and in every single outage."""
