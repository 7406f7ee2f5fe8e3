"""One span with random ports, condensed onto its ends, against a dense Schur complement."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tractionpower.kernels import spans
from tractionpower.kernels.spans import condense, expand, place_ports
from tractionpower.kernels.tables import CONDUCTOR, NO_SLOT, PORT, SEGMENT, SPAN, Network, new_work
from tractionpower.supply.ordering import order_nodes

SEGMENTS = np.array([(-np.inf, 0.0, 0.0, 0.0)], SEGMENT)


def make_span(rng, width, count, *, rail_ohm=1e-5, leaks=False):
    """Return a network of one span whose conductors run between nodes of their own; the last right end is ground.

    Where it leaks, every conductor does, by up to some thousand times as much as rails would.
    """
    length = float(rng.uniform(500.0, 5000.0))
    ohm = [*rng.uniform(2e-5, 1e-4, width - 1), rail_ohm]
    siemens = 10.0 ** rng.uniform(-7.0, -1.0, width) if leaks else np.zeros(width)
    n = 2 * width - 1
    structure = order_nodes(n, [list(range(n + 1))])
    rank = {node: k for k, node in enumerate(structure.order)} | {n: n}
    ends = [(rank[c], rank[c] if ohm[c] == 0.0 else rank[width + c] if width + c < n else n) for c in range(width)]
    left = sorted({a for a, _ in ends} - {n})
    right = sorted({b for _, b in ends} - {n} - set(left))
    terminals = right + left
    slot = {node: k for k, node in enumerate(terminals)}
    fronts = np.cumsum([o > 0.0 for o in ohm]) - 1 + len(terminals)
    ground = int(fronts[-1]) + 1
    conductors = np.zeros(width, CONDUCTOR)
    base = np.zeros(n + 1 + len(structure.row))
    for c, (a, b) in enumerate(ends):
        through, shunt = ladder(ohm[c], siemens[c], length) if ohm[c] > 0.0 else (0.0, 0.5 * siemens[c] * length)
        conductors[c] = (
            ohm[c], siemens[c], through, shunt, a, b, structure.place(a, b),
            slot.get(a, ground), fronts[c] if ohm[c] > 0.0 else NO_SLOT, slot.get(b, ground),
        )  # fmt: skip
        base[[a, b]] += through if a != b else 0.0
        base[structure.place(a, b)] -= through if a != b else 0.0
        base[a] += shunt
        base[b] += shunt
    scatter = [structure.place(terminals[i], terminals[j]) for i in range(len(terminals)) for j in range(i + 1)]
    table = np.zeros(1, SPAN)
    table["length_m"], table["conductors"], table["fronts"] = length, width, np.count_nonzero(ohm)
    table["right_terminals"], table["left_terminals"] = len(right), len(left)
    ports = np.zeros(count, PORT)
    for port in ports:
        positive, negative = rng.choice(width, 2, replace=False)
        port["positive"], port["negative"], port["x_m"] = positive, negative, rng.uniform(0.0, length)
        if rng.random() < 0.3:
            port["x_m"] = rng.choice([0.0, 0.4, length - 0.3, length, *ports["x_m"]])
        port["segments"], port["scale"] = 1, 1.0
    network = Network(
        table, conductors, ports, SEGMENTS, np.array(terminals), np.array(scatter),
        structure.column_start, structure.row, structure.target, base,
    )  # fmt: skip
    return network, structure, ends


def ladder(ohm_per_m, siemens_per_m, length):
    """Return conductance and shunts of a conductor by halving: two equal pi-elements in a row are one of twice the length.

    It begins with pieces so short that half of the leakage stands at either end of the resistance.
    """
    pieces = 2**30
    element = length / pieces
    through, shunt = 1.0 / (ohm_per_m * element), 0.5 * siemens_per_m * element
    while pieces > 1:
        node = through + shunt  # half of what meets in the node between the two
        through, shunt = 0.5 * through**2 / node, shunt * (through + node) / node
        pieces //= 2
    return through, shunt


def dense(network, work, ends):
    """Return the nodal matrix and currents of the span with all its nodes, and the two nodes of every port."""
    n, span = network.nodes, network.spans[0]
    wires, nodes, count = [], np.zeros((len(network.ports), 2), int), n + 1

    def lay(first, second, conductor, length):
        through, shunt = ladder(float(conductor["ohm_per_m"]), float(conductor["siemens_per_m"]), length)
        wires.extend([(first, second, through), (first, n, shunt), (second, n, shunt)])

    for c, (left, right) in enumerate(ends):
        conductor = network.conductors[c]
        ohm, length = float(conductor["ohm_per_m"]), float(span["length_m"])
        last, last_x = left, 0.0
        for p in np.argsort(network.ports["x_m"], kind="stable"):
            for side, name in enumerate(("positive", "negative")):
                if network.ports[name][p] != c:
                    continue
                x = float(network.ports["x_m"][p])
                if ohm == 0.0 or x < 1.0:
                    nodes[p, side] = left
                elif length - x < 1.0:
                    nodes[p, side] = right
                else:
                    if last == left or x - last_x >= 1.0:
                        lay(last, count, conductor, x - last_x)
                        last, last_x, count = count, x, count + 1
                    nodes[p, side] = last
        if ohm > 0.0:
            lay(last, right, conductor, length - last_x)
        else:
            wires.append((left, n, float(conductor["siemens_per_m"]) * length))
    g, b = np.zeros((count, count)), np.zeros(count)
    for i, j, s in [*wires, *((i, j, work.ports["g"][p]) for p, (i, j) in enumerate(nodes))]:
        g[i, i] += s
        g[j, j] += s
        g[i, j] -= s
        g[j, i] -= s
    for p, (i, j) in enumerate(nodes):
        b[i] -= work.ports["j"][p]
        b[j] += work.ports["j"][p]
    return g, b, nodes


def prepare(seed, width, *, sign=1.0, **more):
    rng = np.random.default_rng(seed)
    network, structure, ends = make_span(rng, width, int(rng.integers(1, 12)), **more)
    work = new_work(network)
    place_ports(network, work)
    work.ports["g"] = sign * rng.uniform(0.0, 2.0, len(network.ports))
    work.ports["j"] = rng.normal(size=len(network.ports)) * 1000.0
    work.value[:] = work.step_base
    work.node_v[:] = 0.0
    return network, work, structure, ends, rng


@pytest.mark.parametrize("leaks", [False, True])
@pytest.mark.parametrize("width", [2, 3, 4, 5])
@pytest.mark.parametrize("seed", range(12))
def test_condensed_and_expanded(seed, width, leaks):
    network, work, structure, ends, rng = prepare(seed, width, leaks=leaks)
    assert condense(network, work)
    g, b, nodes = dense(network, work, ends)
    n = network.nodes
    inner = np.arange(n + 1, len(g))
    schur, right = g[: n + 1, : n + 1], b[: n + 1]
    if len(inner):
        back = np.linalg.solve(g[np.ix_(inner, inner)], np.column_stack([g[inner, : n + 1], b[inner]]))
        schur = schur - g[: n + 1, inner] @ back[:, :-1]
        right = right - g[: n + 1, inner] @ back[:, -1]
    ours = np.array([[work.value[structure.place(i, j)] for j in range(n)] for i in range(n)])
    scale = np.abs(schur).max()
    np.testing.assert_allclose(ours, schur[:n, :n], rtol=0.0, atol=1e-11 * scale)
    np.testing.assert_allclose(work.node_v[:n], right[:n], rtol=1e-9, atol=1e-7)

    work.node_v[:n] = v = rng.normal(size=n) * 1000.0
    expand(network, work)
    x = np.zeros(len(g))
    x[:n] = v
    if len(inner):
        x[inner] = np.linalg.solve(g[np.ix_(inner, inner)], b[inner] - g[np.ix_(inner, np.arange(n))] @ v)
    np.testing.assert_allclose(work.ports["u_next"], x[nodes[:, 0]] - x[nodes[:, 1]], rtol=1e-9, atol=1e-7)
    np.testing.assert_allclose(work.sides["node_v"], x[nodes], rtol=1e-9, atol=1e-7)


@pytest.mark.parametrize("seed", range(6))
def test_a_fresh_span_is_not_swept_again(seed):
    network, work, *_ = prepare(seed, 3)
    assert condense(network, work)
    value, node_v = work.value.copy(), work.node_v.copy()
    assert not work.spans["stale"][0]
    work.value[:], work.node_v[:] = work.step_base, 0.0
    assert condense(network, work)
    np.testing.assert_array_equal(work.value, value)
    np.testing.assert_array_equal(work.node_v, node_v)


@pytest.mark.parametrize("leaks", [False, True])
def test_rails_without_resistance(leaks):
    network, work, structure, ends, rng = prepare(5, 3, rail_ohm=0.0, leaks=leaks)
    assert condense(network, work)
    g, b, nodes = dense(network, work, ends)
    n = network.nodes
    work.node_v[:n] = v = rng.normal(size=n) * 1000.0
    expand(network, work)
    inner = np.arange(n + 1, len(g))
    x = np.zeros(len(g))
    x[:n] = v
    x[inner] = np.linalg.solve(g[np.ix_(inner, inner)], b[inner] - g[np.ix_(inner, np.arange(n))] @ v)
    np.testing.assert_allclose(work.ports["u_next"], x[nodes[:, 0]] - x[nodes[:, 1]], rtol=1e-9, atol=1e-7)
    rail = ends[-1][0]
    own = float(network.conductors["siemens_per_m"][-1]) * float(network.spans["length_m"][0])
    assert work.step_base[structure.place(rail, rail)] == own  # all of the leakage at the one node that it is


def test_a_strongly_falling_port_is_told():
    network, work, *_ = prepare(1, 3, sign=-1.0)
    network.ports["x_m"] = np.linspace(100.0, 400.0, len(network.ports))
    work.ports["g"] = -1e4
    place_ports(network, work)
    assert not condense(network, work)
    assert not work.front.any()


@pytest.mark.parametrize("seed", range(6))
def test_a_sweep_leaves_nothing_behind(seed):
    network, work, *_ = prepare(seed, 4)
    assert condense(network, work)
    assert not work.front.any()
    value, node_v = work.value.copy(), work.node_v.copy()
    work.value[:], work.node_v[:], work.spans["stale"] = work.step_base, 0.0, True
    assert condense(network, work)
    np.testing.assert_array_equal(work.value, value)
    np.testing.assert_array_equal(work.node_v, node_v)


def test_ports_are_sorted_by_place():
    network, work, *_ = prepare(2, 4)
    rng = np.random.default_rng(0)
    for _ in range(5):
        network.ports["x_m"] = rng.uniform(0.0, float(network.spans["length_m"][0]), len(network.ports))
        place_ports(network, work)
        assert np.all(np.diff(network.ports["x_m"][work.order]) >= 0.0)
        assert work.spans["ports"][0] == len(network.ports)


def test_ports_between_skeleton_nodes_come_first():
    network, *_ = prepare(1, 3)
    ports = np.concatenate([network.ports, network.ports[:2]])
    ports["span"][-2:] = -1
    network = network._replace(ports=ports)
    work = new_work(network)
    place_ports(network, work)
    assert sorted(work.order[:2]) == [len(ports) - 2, len(ports) - 1]
    assert work.spans["first_port"][0] == 2
    assert work.spans["ports"][0] == len(ports) - 2
    ports["span"][-1] = 0  # and a port may move onto a span
    place_ports(network, work)
    assert work.order[0] == len(ports) - 2
    assert work.spans["ports"][0] == len(ports) - 1


# -- leaky conductors


def wire(ohm_per_m, siemens_per_m):
    conductor = np.zeros(1, CONDUCTOR).view(np.recarray)
    conductor["ohm_per_m"], conductor["siemens_per_m"] = ohm_per_m, siemens_per_m
    return conductor[0]


def pi_element(conductor, length):
    """Return what the kernel's function does; compiled, it exists within its callers only."""
    return getattr(spans.pi_element, "py_func", spans.pi_element)(conductor, length)


@pytest.mark.parametrize("siemens", [1e-9, 1e-6, 1e-5, 1e-3])
@pytest.mark.parametrize("length", [1.0, 100.0, 3000.0, 50_000.0])
def test_pi_element_against_the_telegraph_equation(siemens, length):
    """U'' = r g U, integrated from one end to the other with U(0) = 1 and no current, then with a current of 1 A."""
    ohm = 2e-5
    through, shunt = pi_element(wire(ohm, siemens), length)

    def end(u, i):
        def slope(_, y):
            return [-ohm * y[1], -siemens * y[0]]

        found = solve_ivp(slope, (0.0, length), [u, i], method="DOP853", rtol=1e-12, atol=1e-14)
        return found.y[:, -1]

    for u, i in ((1.0, 0.0), (0.0, 1.0)):
        u_end, i_end = end(u, i)
        inner = i - shunt * u  # what flows through the resistance
        assert u - inner / through == pytest.approx(u_end, rel=1e-8, abs=1e-10)
        assert inner - shunt * (u - inner / through) == pytest.approx(i_end, rel=1e-8, abs=1e-10)


@pytest.mark.parametrize("siemens", [1e-8, 1e-4, 1e-2])
def test_pi_element_is_the_limit_of_a_ladder(siemens):
    assert pi_element(wire(2e-5, siemens), 4000.0) == pytest.approx(ladder(2e-5, siemens, 4000.0), rel=1e-12)


@pytest.mark.parametrize("siemens", [0.0, 1e-300, 1e-30, 1e-18, 1e-12])
def test_what_hardly_leaks_is_a_resistance(siemens):
    conductor = wire(2e-5, siemens)
    through, shunt = pi_element(conductor, 1000.0)
    assert through == pytest.approx(50.0, rel=1e-9)
    assert shunt == pytest.approx(500.0 * siemens, rel=1e-9)


def test_nothing_gets_through_what_leaks_without_end():
    through, shunt = pi_element(wire(1e-2, 1.0), 1e5)
    assert 0.0 <= through < 1e-290
    assert shunt == pytest.approx(np.sqrt(1.0 / 1e-2))


def test_short_and_long_formula_meet():
    limit = 1e-8 / np.sqrt(2e-5 * 1e-9)
    below, above = (pi_element(wire(2e-5, 1e-9), limit * factor) for factor in (1.0 - 1e-12, 1.0 + 1e-12))
    assert below == pytest.approx(above, rel=1e-11)
