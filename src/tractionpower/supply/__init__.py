"""The DC supply: substations, section cabins, contact lines, return circuit and fixed loads, compiled into tables."""
