// The rolling diagrams: u1 and u2, speed, acceleration, force of the first coupling, energy, damage (figure 14 of the paper).
/* global uPlot */

export const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
export const number = (value, decimals) =>
  value === null || value === undefined || Number.isNaN(value) ? "–" : value.toFixed(decimals).replace(/^-(?=0\.?0*$)/, "").replace("-", "−");

const CHARTS = [
  { title: "Controls", small: "drive u₁, brake −u₂", names: ["drive", "brake"], colours: ["blue", "vermilion"], decimals: 0, stepped: true },
  { title: "Speed", unit: "km/h", names: ["speed_kmh"], colours: ["blue"], decimals: 1, least: 10, fromZero: true },
  { title: "Acceleration", small: "first vehicle", unit: "m/s²", names: ["acceleration_mps2"], colours: ["green"], decimals: 3, least: 0.1 },
  {
    title: "First coupling", small: "tension positive", unit: "kN", decimals: 1, least: 20, peaks: true,
    names: ["first_coupling_kn", "first_coupling_least_kn", "first_coupling_greatest_kn"], colours: ["purple", "purple", "purple"],
  },
  { title: "Work of traction", unit: "kWh", names: ["energy_kwh"], colours: ["orange"], decimals: 2, least: 1, fromZero: true },
  { title: "Damage index", small: "cycles of 100 kN, first coupling", names: ["damage_index"], colours: ["sky"], decimals: 3, least: 0.01, fromZero: true },
];
const NAMES = ["time_s", ...CHARTS.flatMap((chart) => chart.names)];
const MOST = 12000; // points kept; then the older half is thinned out
const EXTREME = { first_coupling_least_kn: Math.min, first_coupling_greatest_kn: Math.max }; // of two points that become one

export class Strips {
  constructor(place, windowS) {
    this.windowS = windowS;
    this.data = NAMES.map(() => []);
    this.charts = CHARTS.map((what) => this.#frame(place, what));
    this.sync = uPlot.sync("strips");
    new ResizeObserver(() => this.#resize()).observe(place);
    this.build();
  }

  #frame(place, what) {
    const section = document.createElement("section");
    section.className = "chart";
    const head = document.createElement("header");
    const [title, small, value] = ["span", "small", "b"].map((tag) => head.appendChild(document.createElement(tag)));
    title.textContent = what.unit ? `${what.title} [${what.unit}]` : what.title;
    small.textContent = what.small ?? "";
    const inside = document.createElement("div");
    section.append(head, inside);
    place.append(section);
    return { what, inside, value, plot: null };
  }

  build() {
    for (const chart of this.charts) {
      chart.plot?.destroy();
      chart.plot = new uPlot(this.#options(chart), this.#dataOf(chart, 0), chart.inside);
    }
  }

  #options(chart) {
    const { what, inside } = chart;
    const grid = { stroke: colour("pale"), width: 0.7 };
    const axis = { stroke: colour("grey"), grid, ticks: { show: false }, font: "11px system-ui, sans-serif" };
    return {
      width: Math.max(inside.clientWidth, 80),
      height: Math.max(inside.clientHeight, 40),
      legend: { show: false },
      padding: [6, 12, 0, 0],
      cursor: { sync: { key: "strips" }, y: false, drag: { x: false, y: false }, points: { size: 5 } },
      hooks: { setCursor: [(plot) => { chart.at = plot.cursor.idx; this.#write(chart); }] },
      scales: { x: { time: false }, y: { range: (plot, low, high) => rangeOf(what, this.highest, low, high) } },
      axes: [
        { ...axis, size: 19, gap: 3, space: 60 },
        {
          ...axis, size: 46, gap: 4, space: 22, splits: what.stepped ? () => levelTicks(this.highest) : undefined,
          values: (plot, ticks) => ticks.map((tick) => String(tick).replace("-", "−")),
        },
      ],
      bands: what.peaks ? [{ series: [3, 2], fill: `${colour(what.colours[0])}40` }] : undefined,
      series: [
        {},
        ...what.names.map((name, place) => ({
          stroke: colour(what.colours[place]),
          fill: what.stepped ? `${colour(what.colours[place])}30` : undefined,
          width: what.peaks && place > 0 ? 0.8 : 1.6,
          points: { show: false },
          paths: what.stepped ? uPlot.paths.stepped({ align: 1 }) : undefined,
        })),
      ],
    };
  }

  // Levels of the controls give the range of their diagram.
  setHighest(highest) {
    this.highest = highest;
  }

  add(point) {
    const times = this.data[0];
    const time = point[0];
    if (times.length && time <= times[times.length - 1]) return; // paused
    point.forEach((value, place) => this.data[place].push(NAMES[place] === "brake" ? -value : value));
    if (times.length > MOST) {
      const half = MOST / 2;
      this.data = this.data.map((values, of) => [...thinned(values.slice(0, half), EXTREME[NAMES[of]]), ...values.slice(half)]);
    }
  }

  #dataOf(chart, first) {
    return [this.data[0].slice(first), ...chart.what.names.map((name) => this.data[NAMES.indexOf(name)].slice(first))];
  }

  draw() {
    const times = this.data[0];
    const last = times.length ? times[times.length - 1] : 0;
    const begin = Number.isFinite(this.windowS) ? last - this.windowS : 0;
    let first = times.findIndex((time) => time >= begin);
    first = Math.max(first - 1, 0);
    const span = Number.isFinite(this.windowS) ? this.windowS : Math.max(last, 10);
    for (const chart of this.charts) {
      chart.first = first;
      chart.plot.setData(this.#dataOf(chart, first), false);
      chart.plot.setScale("x", { min: Math.max(begin, 0), max: Math.max(begin, 0) + span });
      this.#write(chart);
    }
  }

  #write(chart) {
    const hovered = chart.at !== null && chart.at !== undefined;
    const row = hovered ? (chart.first ?? 0) + chart.at : this.data[0].length - 1;
    const value = (name) => this.#words(name, this.data[NAMES.indexOf(name)][row], chart.what.decimals);
    const [now, ...others] = chart.what.names.map(value);
    const peaks = hovered ? ` (${others.join(" to ")})` : "";
    const words = chart.what.peaks ? `${now}${peaks}` : [now, ...others].join(" / ");
    const text = hovered ? `${number(this.data[0][row], 1)} s: ${words}` : words;
    if (chart.value.textContent !== text) chart.value.textContent = text;
  }

  // Emergency is counted as a level above the highest of the brake: it has a name, no number.
  #words(name, value, decimals) {
    return name === "brake" && -value > this.highest.brake ? "emergency" : number(value, decimals);
  }

  #resize() {
    for (const { plot, inside } of this.charts) {
      plot.setSize({ width: Math.max(inside.clientWidth, 80), height: Math.max(inside.clientHeight, 40) });
    }
  }
}

// Every second point of an even number, with the extreme of both where the quantity is one.
function thinned(values, extreme) {
  const kept = [];
  for (let k = 1; k < values.length; k += 2) kept.push(extreme ? extreme(values[k - 1], values[k]) : values[k]);
  return kept;
}

// A few levels either way, the highest among them.
function levelTicks(highest) {
  const [drive, brake] = [highest?.drive || 15, highest?.brake || 15];
  return [-brake, -Math.round(brake / 2), 0, Math.round(drive / 2), drive];
}

function rangeOf(what, highest, low, high) {
  if (what.stepped) return [-(highest?.brake || 15) - 1.5, (highest?.drive || 15) + 1.5];
  if (low === null || low === undefined) return what.fromZero ? [0, what.least] : [-what.least, what.least];
  const pad = 0.08 * Math.max(high - low, what.least);
  if (what.fromZero) return [0, Math.max(high + pad, what.least)];
  const missing = Math.max(what.least - (high - low), 0) / 2;
  return [low - pad - missing, high + pad + missing];
}
