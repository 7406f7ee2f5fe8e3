"""Nodes of a topology by the place that they stand for, and what joins them."""

from tractionpower.model.line import Line, Track
from tractionpower.model.supply import ContactLine, ReturnCircuit, Substation, Supply


def line(tracks="12", low=0.0, high=20.0, **more):
    """Return a line of parallel tracks."""
    return Line(tracks=tuple(Track(id=t, from_km=low, to_km=high) for t in tracks), **more)


def lines(*tracks, **more):
    """Return a line of tracks given as (identifier, from, to)."""
    return Line(tracks=tuple(Track(id=t, from_km=low, to_km=high) for t, low, high in tracks), **more)


def station(name="S", km=10.0, **more):
    """Return a substation."""
    return Substation(**({"id": name, "km": km, "no_load_voltage_v": 3600.0, "internal_resistance_ohm": 0.12} | more))


def supply(**more):
    """Return contact lines and one return conductor along all tracks, and what else is given."""
    good = {
        "contact_lines": (ContactLine(from_km=0.0, to_km=20.0, resistance_ohm_per_km=0.05),),
        "return_circuit": (ReturnCircuit(from_km=0.0, to_km=20.0, resistance_ohm_per_km=0.01),),
    }
    return Supply(**(good | more))


def rails_of_each(tracks="12", low=0.0, high=20.0, ohm=0.02, leakage=0.0):
    """Return rails for each track alone."""
    row = {"from_km": low, "to_km": high, "resistance_ohm_per_km": ohm, "leakage_s_per_km": leakage}
    return tuple(ReturnCircuit(tracks=(t,), **row) for t in tracks)


class Graph:
    """Asks a topology which nodes are one."""

    def __init__(self, topology):
        self.topology = topology
        self.links = {link.id: link for link in topology.links}

    def _place(self, track, km):
        bundle = next(bundle for bundle in self.topology.bundles if track in bundle.tracks)
        return bundle, bundle.cut(km)

    def low(self, track, km=10.0):
        """Return the contact line before a place."""
        return self._known("low_km", track, self._place(track, km)[1])

    def high(self, track, km=10.0):
        """Return the contact line behind a place."""
        return self._known("high_km", track, self._place(track, km)[1])

    def rail(self, track, km=10.0, row=None):
        """Return the rails of a track at a place, by default those of its first row there."""
        bundle, cut = self._place(track, km)
        number = bundle.rails_at(track, cut)[0].number if row is None else row
        return self._known("rail", number, bundle.tracks, cut)

    def positive(self, name="S"):
        """Return the positive busbar of a station."""
        return self._known("positive", name)

    def negative(self, name="S"):
        """Return the negative busbar of a substation."""
        return self._known("negative", name)

    def _known(self, *name):
        node = self.topology.nodes.get(*name)
        assert node is not None, name
        return node

    def one(self, *nodes):
        """Tell whether nodes are one, by closed links without resistance too."""
        return len({self.topology.find(node) for node in nodes}) == 1

    def plainly_one(self, *nodes):
        """Tell whether nodes are one whatever is switched."""
        return len({self.topology.plain.find(node) for node in nodes}) == 1

    def ohms(self, *ends):
        """Return the resistances of the edges between two nodes."""
        find = self.topology.find
        wanted = {find(end) for end in ends}
        return [ohm for a, b, ohm in self.topology.edges() if {find(a), find(b)} == wanted]
