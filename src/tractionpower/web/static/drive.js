// The driving page: talks to the program, hands on what it tells, sends what the driver does.
import { Strips, number } from "./charts.js";
import { drawForces, drawWay, followPointer } from "./forces.js";
import { keyLabels, listenToKeys } from "./keys.js";
import { makeLevers, markLevers } from "./levers.js";
import { drawStatistics, makeNumbers, takeStatistics, writeNumbers } from "./numbers.js";
import { at, button, make, notify, onClick, say, write } from "./page.js";

const WINDOWS = [60, 300, Infinity]; // [s]
const SURE_MS = 4000; // for which a second press of Finish ends the drive
const ENDS = { finished: "The end of the case is reached", stopped: "The drive is over", failed: "The computation has failed" };

let hello = null;
let strips = null;
let frame = null;
let shown = null;
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
  if (!isOver) say("The connection to the program is lost. If it still runs, load this page again.");
};
const send = (order) => socket.readyState === WebSocket.OPEN && socket.send(JSON.stringify(order));

const HANDLERS = {
  hello: greet,
  history(message) { message.points.forEach((point) => strips.add(point)); },
  frame(message) {
    frame = message;
    frame.points.forEach((point) => strips.add(point));
  },
  statistics: takeStatistics,
  notice(message) { notify(message.text); },
  over(message) {
    isOver = true;
    const where = message.why === "failed" ? "the terminal says why." : `results go to ${hello.folder}.`;
    say(`${ENDS[message.why] ?? "The drive is over"} at ${number(message.time_s, 1)} s; ${where} This page may be closed.`);
    document.body.classList.add("over");
    shown = null; // a long word here takes room from what is drawn
    drawStatistics();
    document.querySelectorAll("button").forEach((made) => { made.disabled = made.id !== "theme"; });
  },
};

async function greet(message) {
  hello = message;
  document.title = `${hello.name} – driving`;
  write("name", hello.name);
  at("case").title = hello.name;
  const powered = hello.powered.filter(Boolean).length;
  const weights = `${number(hello.mass_t, 0)} t, ${number(hello.length_m, 0)} m`;
  write("train", `${hello.vehicles.length} vehicles, ${powered} powered, ${weights}, step ${1000 * hello.step_s} ms`);
  strips = new Strips(at("charts"), WINDOWS[0]);
  strips.setHighest(hello.highest);
  makeNumbers(hello);
  makeButtons();
  listenToKeys(hello.keys.keys, send);
  makeLevers(hello, await keyLabels(hello.keys.keys), send);
  requestAnimationFrame(draw);
}

function makeButtons() {
  for (const factor of hello.factors) {
    const made = button(`${factor}×`, () => send({ factor }), `${factor} simulated seconds in a second`);
    made.dataset.factor = factor;
    at("factors").append(made);
  }
  for (const name of ["pause", "emergency"]) onClick(at(name), () => send({ do: name }));
  makeFinish();
  onClick(at("theme"), () => setTheme(document.documentElement.dataset.theme === "dark" ? "light" : "dark"));
  for (const seconds of WINDOWS) {
    const words = Number.isFinite(seconds) ? `${seconds / 60} min` : "all";
    const made = button(words, () => { strips.windowS = seconds; markWindow(); }, "What the diagrams show");
    made.dataset.window = seconds;
    at("windows").append(made);
  }
  markWindow();
}

// The drive cannot be gone on with: Finish asks, by its own button, so that the keys go on working.
function makeFinish() {
  let timer = 0;
  const ask = (isSure) => { at("finish").classList.toggle("sure", isSure); write("finish", isSure ? "End the drive?" : "Finish"); };
  onClick(at("finish"), (event) => {
    if (event.detail > 1) return; // a double click is no answer
    clearTimeout(timer);
    if (at("finish").classList.contains("sure")) {
      send({ do: "finish" });
      ask(false);
    } else {
      ask(true);
      timer = setTimeout(ask, SURE_MS, false);
    }
  });
}

function markWindow() {
  document.querySelectorAll("#windows button").forEach((made) => made.classList.toggle("on", Number(made.dataset.window) === strips.windowS));
}

function draw(now) {
  if (frame !== shown && frame) {
    shown = frame;
    drawn.push(now);
    drawn = drawn.filter((time) => time > now - 1000);
    strips.draw();
    writeNumbers(hello.panel, frame, drawn.length);
    drawForces(hello, frame.snapshot);
    drawWay(hello, frame.snapshot);
    markLevers(hello, frame.snapshot, frame.desk.levels);
    markDesk(frame.snapshot, frame.desk);
  }
  requestAnimationFrame(draw);
}

function markDesk(snapshot, desk) {
  document.querySelectorAll("#factors button").forEach((made) => made.classList.toggle("on", Number(made.dataset.factor) === desk.factor));
  const hasBegun = snapshot.time_s > 0;
  write("pause", desk.paused ? (hasBegun ? "Go on" : "Start") : "Pause");
  if (isOver) return;
  if (desk.paused) say(hasBegun ? "Paused: press P to go on" : "Press Enter to start, or move a control");
  else say("");
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
followPointer(() => frame && drawForces(hello, frame.snapshot));
addEventListener("resize", () => { shown = null; drawStatistics(); });
