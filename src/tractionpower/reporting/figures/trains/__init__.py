"""Figures of trains: train graph, single trains, theoretical journeys, curves of vehicles."""
