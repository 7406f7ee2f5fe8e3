"""An independent solver for small DC networks: dense nodal analysis of `dense_network`.

The currents of the ports are plain formulas and the method is a descent with modified eigenvalues. It is slow and simple;
what it finds, the solver must find. Potentials are those against remote earth where a part of the network knows it, else
against the negative busbar of its first substation.
"""

import numpy as np

BLOCKED_S = 1e-9
CEILING_RAMP_V = 1e-3
STEP_V = 300.0
POLISH_V = 1e-3
ROUNDING = 64.0 * np.finfo(float).eps
"""Share of the absolute currents of a node that may be left over by rounding."""


class NoSolutionError(Exception):
    """The reference found no solution."""


def inner_ohm(station):
    """Return the internal resistance of a substation with the units that it has in service."""
    k = station.units if station.units_in_service is None else station.units_in_service
    grid = station.grid_resistance_ohm
    return (station.internal_resistance_ohm - grid) * station.units / k + grid


class Ports:
    """Currents that the ports take, by the formulas of the physics document; sources first."""

    def __init__(self, network):
        voltages, loads = network.voltages, network.loads
        self.e = np.array([s.no_load_voltage_v * s.grid_voltage_pu for s in network.sources])
        self.r = np.array([inner_ohm(s) for s in network.sources])
        self.both = np.array([s.conducts == "both" for s in network.sources], bool)
        self.p = np.array([0.0 if load.power_kw is None else 1e3 * load.power_kw for load in loads])
        self.i = np.array([load.current_a or 0.0 for load in loads])
        self.free = np.array([load.limits == "none" for load in loads], bool)
        self.low = np.where(self.free, 0.05 * voltages.u_n, voltages.u_min2)
        self.high = np.where(self.free | (self.p + self.i > 0.0), np.inf, voltages.u_max2)
        self.fold = np.array([min(load.fold_back_from_v or voltages.u_max1, voltages.u_max2 - CEILING_RAMP_V) for load in loads])
        self.fold = np.where(np.isinf(self.high), np.inf, self.fold)
        self.ceiling = 5.0 * voltages.u_max2

    def sources(self, u):
        """Return currents taken (negative: given) and slopes."""
        conducting = self.both | (u <= self.e)
        slope = np.where(conducting, 1.0 / self.r, BLOCKED_S)
        return slope * (u - self.e), slope

    def demands(self, u):
        """Return currents taken and slopes of the loads."""
        safe = np.maximum(u, self.low)
        i, slope = self.i + self.p / safe, -self.p / safe**2
        taking = self.p + self.i > 0.0
        below = (u < self.low) | (taking & (u <= self.low))
        at_low = (self.i + self.p / self.low) / self.low
        with np.errstate(invalid="ignore"):
            share = np.where(u >= self.fold, (self.high - u) / (self.high - self.fold), 1.0)
            bend = np.where(u >= self.fold, -1.0 / (self.high - self.fold), 0.0)
        i, slope = i * share, slope * share + i * bend
        i, slope = np.where(below, at_low * u, i), np.where(below, at_low, slope)
        off = (u <= 0.0) & ~((u == 0.0) & taking) | (u > self.high)
        return np.where(off, 0.0, i), np.where(off, 0.0, slope)


class DenseSolver:
    """Finds the potentials of the part of a network that sources feed.

    The descent works on the nodes of ports alone: the others are eliminated once. What it finds is polished on all nodes.
    """

    def __init__(self, network):
        self.network, self.ports = network, Ports(network)
        n = len(network.index)
        ground = {network.part[network.earth]: network.earth} if network.earth >= 0 else {}
        for p, (_, j) in zip([network.part[i] for i, _ in network.source], network.source, strict=True):
            ground.setdefault(p, int(j))
        pairs = [*network.source, *network.load[network.live]]
        ends = {int(k) for pair in pairs for k in pair}
        free = [k for k in range(n) if network.fed[k] and ground[network.part[k]] != k]
        self.free = np.array(sorted(free, key=lambda k: (k not in ends, k)), int)
        incidence = np.zeros((len(pairs), n))
        for k, (i, j) in enumerate(pairs):
            incidence[k, i] += 1.0
            incidence[k, j] -= 1.0
        self.whole_a = incidence[:, self.free]
        self.whole_g = network.g[np.ix_(self.free, self.free)]
        m = sum(k in ends for k in free)
        inner, across = self.whole_g[m:, m:], self.whole_g[m:, :m]
        self.back = -np.linalg.solve(inner, across) if len(inner) else np.zeros((0, m))
        self.a, self.g = self.whole_a[:, :m], self.whole_g[:m, :m] + across.T @ self.back
        self.g = 0.5 * (self.g + self.g.T)
        self.start = network.no_load[self.free[:m]]

    def currents(self, u, factor):
        """Return currents and slopes of all live ports, the demand multiplied by `factor`."""
        sources = len(self.ports.e)
        everywhere = np.zeros(len(self.network.load))
        everywhere[self.network.live] = u[sources:]
        i, g = self.ports.demands(everywhere)
        live = self.network.live
        source_i, source_g = self.ports.sources(u[:sources])
        return np.concatenate([source_i, factor * i[live]]), np.concatenate([source_g, factor * g[live]])

    def _gradient(self, v, factor):
        return self.g @ v + self.a.T @ self.currents(self.a @ v, factor)[0]

    def _direction(self, f, slopes):
        h = self.g + (self.a.T * slopes) @ self.a
        try:
            np.linalg.cholesky(h)
            return np.linalg.solve(h, -f)
        except np.linalg.LinAlgError:
            values, vectors = np.linalg.eigh(h)
            values = np.maximum(np.abs(values), 1e-6 * np.max(np.diag(self.g), initial=1e-3))
            return -vectors @ ((vectors.T @ f) / values)

    def descend(self, v, factor, most=400):
        """Return the potentials where the descent from `v` ends; they balance to rounding."""
        best, stalled = np.inf, 0
        absolute, weights = np.abs(self.g), np.abs(self.a.T)
        for _ in range(most):
            u = self.a @ v
            i, slopes = self.currents(u, factor)
            f = self.g @ v + self.a.T @ i
            worst = np.max(np.abs(f), initial=0.0)
            stalled = 0 if worst < 0.5 * best else stalled + 1
            best = min(best, worst)
            if worst <= 1e-8:
                return v
            if stalled > 2 and np.all(np.abs(f) <= 1e-6 + ROUNDING * (absolute @ np.abs(v) + weights @ np.abs(slopes * u))):
                return v
            d = self._direction(f, slopes)
            longest = np.max(np.abs(d))
            v = v + self._length(v, d, min(1.0, STEP_V / longest), float(d @ f), factor) * d
        raise NoSolutionError(f"{worst} A are left")

    def _length(self, v, d, high, start, factor):
        """Return a length where the potential no longer falls steeply, by bisection on its derivative."""
        if float(d @ self._gradient(v + high * d, factor)) <= -0.5 * start:
            return high
        low = 0.0
        for _ in range(60):
            t = 0.5 * (low + high)
            fall = float(d @ self._gradient(v + t * d, factor))
            if abs(fall) <= -0.5 * start:
                break
            low, high = (t, high) if fall < 0.0 else (low, t)
        return t

    def polish(self, v):
        """Return the potentials of all nodes, those of dead parts zero, from those of the nodes of ports.

        A larger step would be one of a stretch that only blocked rectifiers hold, where rounding decides.
        """
        v = np.concatenate([v, self.back @ v])
        i, slopes = self.currents(self.whole_a @ v, 1.0)
        h = self.whole_g + (self.whole_a.T * slopes) @ self.whole_a
        step = np.linalg.solve(h, self.whole_g @ v + self.whole_a.T @ i)
        if np.max(np.abs(step), initial=0.0) < POLISH_V:
            v = v - step
        whole = np.zeros(len(self.network.index))
        whole[self.free] = v
        return whole

    def potentials(self, factors=(1.0,)):
        """Return the potentials of all nodes along a rising common load factor from no load, None if it ends nowhere."""
        v = self.start
        try:
            for factor in factors:
                v = self.descend(v, factor)
        except NoSolutionError:
            return None
        return self.polish(v)

    def voltages(self, v):
        """Return the voltages of the live ports at the potentials of all nodes."""
        return self.whole_a @ v[self.free]

    def solve(self):
        """Solve from no load at once, and along a rising common load factor; return the potentials of both.

        Where only one of the two ends anywhere, the other is None.
        """
        return [self.potentials(factors) for factors in ((1.0,), (0.0, 0.3, 0.6, 0.8, 0.9, 1.0))]

    def servable(self, u):
        """Tell whether all loads without limits sit at voltages where they are what they say."""
        network, ports = self.network, self.ports
        demand, live = u[len(ports.e) :], network.live
        free = ports.free[live]
        return bool(np.all(demand[free] >= ports.low[live][free]) and np.all(demand[free] <= ports.ceiling))


def balance(network, v, u):
    """Return what is left over in every node at the potentials `v` of all nodes and the voltages `u` of all ports [A]."""
    ports = Ports(network)
    left = network.g @ v
    sources = len(network.source)
    for pairs, i in ((network.source, ports.sources(u[:sources])[0]), (network.load, ports.demands(u[sources:])[0])):
        np.add.at(left, pairs[:, 0], i)
        np.subtract.at(left, pairs[:, 1], i)
    return left
