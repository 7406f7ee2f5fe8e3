// The numbers of the panel, time and pace at the top, and the statistics up to now.
import { drawBars, drawHeat } from "./canvas.js";
import { number } from "./charts.js";
import { at, make, write } from "./page.js";

const STATISTICS = [
  { name: "drive_speed", title: "P{u₁, v}", unit: "km/h", heat: "blue" },
  { name: "brake_speed", title: "P{u₂, v}", unit: "km/h", heat: "vermilion" },
  { name: "force", title: "First coupling", unit: "kN", bars: "purple" },
  { name: "acceleration", title: "Acceleration", unit: "m/s²", bars: "green" },
  { name: "rainflow", title: "Rainflow, first coupling", unit: "range, kN", bars: "orange", logarithmic: true },
];

let statistics = null;
let highestBrake = 0;

export function makeNumbers(hello) {
  highestBrake = hello.highest.brake;
  for (const item of hello.panel) {
    const value = make("dd", "–");
    value.id = `value-${item.name}`;
    at("panel").append(make("dt", item.label), value, make("small", item.unit));
  }
  for (const item of STATISTICS) {
    const figure = make("figure");
    const caption = make("figcaption");
    item.value = make("b");
    caption.append(make("span", item.title), make("span", `[${item.unit}]`, "legend"), item.value);
    item.canvas = make("canvas");
    item.canvas.id = `statistics-${item.name}`;
    figure.append(caption, item.canvas);
    at("statistics").append(figure);
  }
}

export function writeNumbers(panel, { snapshot, desk }, drawnPerS) {
  for (const item of panel) {
    const value = snapshot[item.name];
    write(`value-${item.name}`, typeof value === "number" ? number(value, item.decimals) : "–");
  }
  const minutes = Math.floor(snapshot.time_s / 60);
  write("clock", `${minutes}:${number(snapshot.time_s - 60 * minutes, 1).padStart(4, "0")}`);
  write("speed", number(snapshot.speed_kmh, 1));
  write("steps", number(desk.steps_per_s, 0));
  write("frames", number(desk.frames_per_s, 0));
  write("drawn", String(drawnPerS));
  write("lag", number(desk.lag_ms, 1));
  write("longest", number(desk.longest_lag_ms, 1));
  at("given-up").hidden = desk.given_up_s <= 0;
  at("given-up").className = "late";
  write("given-up", `given up ${number(desk.given_up_s, 2)} s`);
}

export function takeStatistics(message) {
  statistics = message;
  drawStatistics();
}

export function drawStatistics() {
  if (!statistics) return;
  for (const item of STATISTICS) {
    const data = statistics[item.name];
    if (item.heat) {
      const most = drawHeat(item.canvas, data, item.heat, item.name === "brake_speed" ? highestBrake : Infinity);
      item.canvas.title = most > 0 ? `Relative frequency; the darkest cell: ${number(most, 3)}` : "";
    } else {
      drawBars(item.canvas, data, item.bars, item.logarithmic);
      if (item.logarithmic) item.value.textContent = `${number(data.bars.reduce((sum, value) => sum + value, 0), 1)} cycles`;
    }
  }
}
