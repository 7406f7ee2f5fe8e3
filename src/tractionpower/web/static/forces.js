// The forces along the train with their extremes, and the track: both are read with the pointer.
import { drawAlong, drawTrack } from "./canvas.js";
import { number } from "./charts.js";
import { at, write } from "./page.js";

let along = null;
let hovered = null;

// The extremes come from the program, which compares every step: what is shown here is one instant in some.
export function drawForces(hello, snapshot) {
  const forces = snapshot.forces_kn;
  const extremes = { most: snapshot.greatest_kn, least: snapshot.least_kn };
  along = drawAlong(at("along").querySelector("canvas"), forces, extremes, hello.limits);
  const j = hovered === null ? -1 : Math.floor((hovered - along.left) / along.pitch);
  const isOne = j >= 0 && j < forces.length;
  const range = isOne ? `${number(extremes.least[j], 1)} to ${number(extremes.most[j], 1)}` : "";
  write("along-value", isOne ? `${j + 1}|${j + 2}: ${number(forces[j], 1)} now, ${range} so far` : "");
}

export function drawWay(hello, snapshot) {
  const gradient = snapshot.gradient_permille ?? 0;
  write("track-value", `${number(snapshot.position_m, 0)} m · ${gradient > 0 ? "+" : ""}${number(gradient, 1)} ‰`);
  drawTrack(at("track").querySelector("canvas"), hello.profile, hello.curves, snapshot.position_m, hello.length_m);
}

export function followPointer(redraw) {
  at("along").addEventListener("mousemove", (event) => { hovered = event.offsetX; redraw(); });
  at("along").addEventListener("mouseleave", () => { hovered = null; redraw(); });
}
