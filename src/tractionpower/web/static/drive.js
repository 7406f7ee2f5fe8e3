// The driving page: talks to the program, shows what it tells, sends what the driver does. Texts are never read as HTML.
import { drawAlong, drawBars, drawHeat, drawTrack } from "./canvas.js";
import { Strips, number } from "./charts.js";
import { keyLabels, listenToKeys } from "./keys.js";

const at = (id) => document.getElementById(id);
const make = (tag, words = "", className = "") => Object.assign(document.createElement(tag), { textContent: words, className });
const write = (id, words) => { const place = at(id); if (place.textContent !== words) place.textContent = words; };

const WINDOWS = [60, 300, Infinity]; // [s]
const STATISTICS = [
  { name: "drive_speed", title: "P{u₁, v}", unit: "km/h", heat: "blue" },
  { name: "brake_speed", title: "P{u₂, v}", unit: "km/h", heat: "vermilion" },
  { name: "force", title: "First coupling", unit: "kN", bars: "purple" },
  { name: "acceleration", title: "Acceleration", unit: "m/s²", bars: "green" },
  { name: "rainflow", title: "Rainflow cycles by range, first coupling", unit: "kN", bars: "orange", logarithmic: true },
];

let hello = null;
let strips = null;
let frame = null;
let statistics = null;
let extremes = { most: [], least: [] };
let along = null;
let hovered = null;
let isOver = false;
let drawn = [];

const address = new URL("/socket", location.href);
address.protocol = "ws:";
address.search = location.search;
const socket = new WebSocket(address);
socket.onmessage = (event) => {
  const message = JSON.parse(event.data);
  HANDLERS[message.kind]?.(message);
};
socket.onclose = () => {
  if (!isOver) banner("The connection to the program is lost. If it still runs, load this page again.");
};
const send = (order) => socket.readyState === WebSocket.OPEN && socket.send(JSON.stringify(order));

const HANDLERS = {
  hello: greet,
  history(message) { message.points.forEach((point) => strips.add(point)); },
  frame: show,
  statistics(message) { statistics = message; drawStatistics(); },
  notice(message) { notify(message.text); },
  over(message) {
    isOver = true;
    const why = { finished: "The end of the case is reached", stopped: "The drive is over", failed: "The computation has failed" };
    const where = message.why === "failed" ? "; the terminal says why." : `: results are written into ${hello.folder}.`;
    banner(`${why[message.why] ?? "The drive is over"} at ${number(message.time_s, 1)} s${where} This page may be closed.`);
    document.querySelectorAll("button").forEach((button) => { button.disabled = button.id !== "theme"; });
  },
};

async function greet(message) {
  hello = message;
  document.title = `${hello.name} – driving`;
  write("name", hello.name);
  const powered = hello.powered.filter(Boolean).length;
  const weights = `${number(hello.mass_t, 0)} t, ${number(hello.length_m, 0)} m`;
  write("train", `${hello.vehicles.length} vehicles, ${powered} powered, ${weights}, step ${1000 * hello.step_s} ms`);
  strips = new Strips(at("charts"), WINDOWS[0]);
  strips.setHighest(hello.highest);
  makePanel();
  makeStatistics();
  makeButtons();
  listenToKeys(hello.keys.keys, send);
  const labels = await keyLabels(hello.keys.keys);
  makeLevers(labels);
  makeHints(labels);
  requestAnimationFrame(draw);
}

function makePanel() {
  for (const item of hello.panel) {
    const value = make("dd", "–");
    value.id = `value-${item.name}`;
    at("panel").append(make("dt", item.label), value, make("small", item.unit));
  }
}

function makeStatistics() {
  for (const item of STATISTICS) {
    const figure = make("figure");
    const caption = make("figcaption");
    item.value = make("b");
    caption.append(make("span", item.title), make("span", `[${item.unit}]`, "legend"), item.value);
    item.canvas = make("canvas");
    figure.append(caption, item.canvas);
    at("statistics").append(figure);
  }
}

function button(words, order, title = "") {
  const made = make("button", words);
  made.type = "button";
  made.title = title;
  made.addEventListener("click", () => { send(order); made.blur(); });
  return made;
}

function makeButtons() {
  for (const factor of hello.factors) {
    const made = button(`${factor}×`, { factor }, `${factor} simulated seconds in a second`);
    made.dataset.factor = factor;
    at("factors").append(made);
  }
  for (const [id, name] of [["pause", "pause"], ["finish", "finish"], ["emergency", "emergency"]]) {
    at(id).addEventListener("click", (event) => { send({ do: name }); event.currentTarget.blur(); });
  }
  at("theme").addEventListener("click", (event) => {
    setTheme(document.documentElement.dataset.theme === "dark" ? "light" : "dark");
    event.currentTarget.blur();
  });
  const choice = make("span");
  choice.id = "windows";
  for (const seconds of WINDOWS) {
    const words = Number.isFinite(seconds) ? `${seconds / 60} min` : "all";
    const made = make("button", words);
    made.type = "button";
    made.title = "What the diagrams show";
    made.addEventListener("click", () => { strips.windowS = seconds; markWindow(); made.blur(); });
    made.dataset.window = seconds;
    choice.append(made);
  }
  at("buttons").prepend(choice);
  markWindow();
}

function markWindow() {
  document.querySelectorAll("#windows button").forEach((made) => made.classList.toggle("on", Number(made.dataset.window) === strips.windowS));
}

function makeLevers(labels) {
  for (const control of ["drive", "brake"]) {
    const lever = make("div", "", `lever ${control}`);
    const head = make("h2", control === "drive" ? "Drive u₁" : "Brake u₂");
    const value = make("b", "0");
    value.id = `lever-${control}`;
    head.append(value);
    const notches = make("div", "", "notches");
    const keyOf = Object.fromEntries(
      Object.entries(hello.keys.keys).filter(([, order]) => order.set === control).map(([code, order]) => [order.level, labels[code]]),
    );
    for (let level = Math.max(hello.highest[control], 15); level >= 0; level -= 1) {
      const made = button(String(level), { set: control, level });
      made.append(make("kbd", keyOf[level] ?? ""));
      made.dataset.level = level;
      made.disabled = level > hello.highest[control];
      notches.append(made);
    }
    lever.append(head, notches);
    at("levers").append(lever);
  }
  if (hello.highest.electric > 0) makeElectric(labels);
  if (hello.independent) makeIndependent();
}

function makeElectric(labels) {
  const place = at("electric");
  const head = make("div", "", "label");
  head.append(make("span", "Electric brake"), make("kbd", `${labels.KeyU} less · ${labels.KeyI} more`));
  const notches = make("div", "", "notches");
  for (let level = 0; level <= hello.highest.electric; level += 1) {
    const made = button(String(level), { set: "electric", level });
    made.dataset.level = level;
    notches.append(made);
  }
  place.append(head, notches);
  place.hidden = false;
}

function makeIndependent() {
  const place = at("independent");
  const head = make("div", "", "label");
  const value = make("b", "0.0 bar");
  head.append(make("span", "Independent brake"), value);
  const slider = Object.assign(document.createElement("input"), { type: "range", min: 0, max: hello.highest_bar, step: 0.1, value: 0 });
  slider.setAttribute("aria-label", "Independent brake");
  slider.addEventListener("input", () => {
    value.textContent = `${number(slider.valueAsNumber, 1)} bar`;
    send({ set: "independent", bar: slider.valueAsNumber });
  });
  slider.addEventListener("change", () => slider.blur());
  place.append(head, slider);
  place.hidden = false;
}

function makeHints(labels) {
  const add = (keys, words) => {
    keys.forEach((key) => at("hints").append(make("kbd", labels[key]), " "));
    at("hints").append(`${words} `, make("br"));
  };
  add(["ArrowUp", "ArrowDown"], "drive more, less");
  add(["ArrowRight", "ArrowLeft"], "brake more, less");
  add(["Enter"], "start");
  at("hints").lastChild.remove();
  at("hints").append("· ");
  add(["KeyP"], "pause");
  add(["Comma", "Period"], "time slower, faster");
  at("hints").title = "Keys are known by their place on the keyboard, so the rows are the same on QWERTY, QWERTZ and AZERTY.";
}

function show(message) {
  frame = message;
  const { snapshot } = frame;
  frame.points.forEach((point) => strips.add(point));
  const forces = snapshot.forces_kn ?? [];
  if (extremes.most.length !== forces.length) extremes = { most: forces.map(() => 0), least: forces.map(() => 0) };
  forces.forEach((force, j) => {
    extremes.most[j] = Math.max(extremes.most[j], force);
    extremes.least[j] = Math.min(extremes.least[j], force);
  });
}

let shown = null;
function draw(now) {
  if (frame !== shown && frame) {
    shown = frame;
    drawn.push(now);
    drawn = drawn.filter((time) => time > now - 1000);
    strips.draw();
    writeNumbers();
    drawForces();
    drawTrack(at("track").querySelector("canvas"), hello.profile, hello.curves, frame.snapshot.position_m, hello.length_m);
  }
  requestAnimationFrame(draw);
}

function drawForces() {
  const forces = frame.snapshot.forces_kn ?? [];
  along = drawAlong(at("along").querySelector("canvas"), forces, extremes, hello.limits);
  const j = hovered === null ? -1 : Math.floor((hovered - along.left) / along.pitch);
  const isOne = j >= 0 && j < forces.length;
  const range = isOne ? `${number(extremes.least[j], 1)} to ${number(extremes.most[j], 1)}` : "";
  write("along-value", isOne ? `${j + 1}|${j + 2}: ${number(forces[j], 1)} now, ${range} so far` : "");
}

function writeNumbers() {
  const { snapshot, desk } = frame;
  const gradient = snapshot.gradient_permille ?? 0;
  for (const item of hello.panel) {
    const value = snapshot[item.name];
    write(`value-${item.name}`, typeof value === "number" ? number(value, item.decimals) : "–");
  }
  const minutes = Math.floor(snapshot.time_s / 60);
  write("clock", `${minutes}:${number(snapshot.time_s - 60 * minutes, 1).padStart(4, "0")}`);
  write("speed", number(snapshot.speed_kmh, 1));
  write("track-value", `${number(snapshot.position_m, 0)} m · ${gradient > 0 ? "+" : ""}${number(gradient, 1)} ‰`);
  write("steps", number(desk.steps_per_s, 0));
  write("frames", number(desk.frames_per_s, 0));
  write("drawn", String(drawn.length));
  write("lag", number(desk.lag_ms, 1));
  write("longest", number(desk.longest_lag_ms, 1));
  at("given-up").hidden = desk.given_up_s <= 0;
  at("given-up").className = "late";
  write("given-up", `given up ${number(desk.given_up_s, 2)} s`);
  markControls(snapshot, desk);
}

function markControls(snapshot, desk) {
  const isEmergency = snapshot.brake > hello.highest.brake;
  for (const control of ["drive", "brake"]) {
    const level = Math.min(snapshot[control] ?? 0, hello.highest[control]);
    write(`lever-${control}`, control === "brake" && isEmergency ? "EM" : String(level));
    document.querySelectorAll(`.lever.${control} .notches button`).forEach((made) => {
      const its = Number(made.dataset.level);
      made.classList.toggle("now", its === level);
      made.classList.toggle("lit", its > 0 && its < level);
    });
  }
  document.querySelectorAll("#electric button").forEach((made) => made.classList.toggle("now", Number(made.dataset.level) === desk.levels.electric));
  document.querySelectorAll("#factors button").forEach((made) => made.classList.toggle("on", Number(made.dataset.factor) === desk.factor));
  at("emergency").classList.toggle("now", isEmergency);
  const hasBegun = snapshot.time_s > 0;
  write("pause", desk.paused ? (hasBegun ? "Go on" : "Start") : "Pause");
  if (isOver) return;
  if (desk.paused) banner(hasBegun ? "Paused: press P to go on" : "Press Enter to start, or move a control");
  else at("banner").hidden = true;
}

function drawStatistics() {
  if (!statistics) return;
  for (const item of STATISTICS) {
    const data = statistics[item.name];
    if (item.heat) {
      const most = drawHeat(item.canvas, data, item.heat);
      item.canvas.title = `Relative frequency; the darkest cell: ${number(most, 3)}`;
    } else {
      drawBars(item.canvas, data, item.bars, item.logarithmic);
      if (item.logarithmic) item.value.textContent = number(data.bars.reduce((sum, value) => sum + value, 0), 1);
    }
  }
}

function banner(words) {
  write("banner", words);
  at("banner").hidden = false;
}

let noticeTimer = 0;
function notify(words) {
  write("notice", words);
  at("notice").hidden = false;
  clearTimeout(noticeTimer);
  noticeTimer = setTimeout(() => { at("notice").hidden = true; }, 4000);
}

function setTheme(theme) {
  document.documentElement.dataset.theme = theme;
  try { localStorage.setItem("theme", theme); } catch { /* private windows keep nothing */ }
  strips?.build();
  shown = null;
  drawStatistics();
}

function chosenTheme() {
  try { return localStorage.getItem("theme"); } catch { return null; }
}

const wishes = matchMedia("(prefers-color-scheme: dark)");
document.documentElement.dataset.theme = chosenTheme() ?? (wishes.matches ? "dark" : "light");
wishes.addEventListener("change", () => setTheme(wishes.matches ? "dark" : "light"));
at("along").addEventListener("mousemove", (event) => { hovered = event.offsetX; if (frame) drawForces(); });
at("along").addEventListener("mouseleave", () => { hovered = null; });
addEventListener("resize", () => { shown = null; drawStatistics(); });
