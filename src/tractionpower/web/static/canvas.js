// What is drawn on plain canvases: forces along the train, the track ahead, joint distributions, histograms.
import { colour, number } from "./charts.js";

const FONT = "10px system-ui, sans-serif";

// Gives a context in CSS pixels, cleared, with the size of the canvas as it stands on the page.
function begin(canvas) {
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  const ratio = devicePixelRatio || 1;
  const [wide, high] = [Math.round(width * ratio), Math.round(height * ratio)];
  if (canvas.width !== wide || canvas.height !== high) [canvas.width, canvas.height] = [wide, high];
  const ctx = canvas.getContext("2d");
  ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
  ctx.clearRect(0, 0, width, height);
  ctx.font = FONT;
  return { ctx, width, height };
}

function text(ctx, words, x, y, align = "left", name = "grey") {
  ctx.fillStyle = colour(name);
  ctx.textAlign = align;
  ctx.fillText(words, x, y);
}

function line(ctx, x0, y0, x1, y1, name, dash = []) {
  ctx.strokeStyle = colour(name);
  ctx.setLineDash(dash);
  ctx.beginPath();
  ctx.moveTo(x0, y0);
  ctx.lineTo(x1, y1);
  ctx.stroke();
  ctx.setLineDash([]);
}

// The step of some `count` round ticks over a span: 1, 2 or 5 times a power of ten.
function tickStep(span, count) {
  const raw = span / count;
  const power = 10 ** Math.floor(Math.log10(raw));
  return power * ([1, 2, 5, 10].find((factor) => factor * power >= raw) ?? 10);
}

function ticks(low, high, count) {
  const step = tickStep(high - low, count);
  const found = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k += 1) found.push(k * step);
  return { found, decimals: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) };
}

export function drawAlong(canvas, forces, extremes, limits) {
  const { ctx, width, height } = begin(canvas);
  const [left, right, top, bottom] = [40, 8, 5, 15];
  const high = Math.max(20, ...extremes.most, ...forces) * 1.08;
  const low = Math.min(-20, ...extremes.least, ...forces) * 1.08;
  const y = (value) => top + ((high - value) / (high - low)) * (height - top - bottom);
  const { found, decimals } = ticks(low, high, Math.max(2, (height - 20) / 26));
  ctx.lineWidth = 0.7;
  for (const tick of found) {
    line(ctx, left, y(tick), width - right, y(tick), "pale");
    text(ctx, number(tick, decimals), left - 5, y(tick) + 3.5, "right");
  }
  const pitch = (width - left - right) / Math.max(forces.length, 1);
  const bar = Math.max(pitch * 0.78, 1);
  const every = tickStep(forces.length, Math.max((width - left) / 70, 1));
  forces.forEach((force, j) => {
    const x = left + j * pitch + (pitch - bar) / 2;
    ctx.fillStyle = colour(force >= 0 ? "blue" : "vermilion");
    ctx.fillRect(x, Math.min(y(0), y(force)), bar, Math.max(Math.abs(y(force) - y(0)), 0.6));
    ctx.fillStyle = colour("grey");
    for (const extreme of [extremes.most[j], extremes.least[j]]) ctx.fillRect(x, y(extreme) - 0.75, bar, 1.5);
    for (const limit of [limits[j]?.tension_kn ?? null, limits[j]?.compression_kn ? -limits[j].compression_kn : null]) {
      if (limit !== null && limit < high && limit > low) line(ctx, x, y(limit), x + bar, y(limit), "orange");
    }
    if (j === 0 || (j + 1) % Math.max(every, 1) === 0) text(ctx, `${j + 1}|${j + 2}`, x + bar / 2, height - 3, "center");
  });
  ctx.lineWidth = 1;
  line(ctx, left, y(0), width - right, y(0), "grey");
  return { left, pitch };
}

export function drawTrack(canvas, profile, curves, place, length) {
  const { ctx, width, height } = begin(canvas);
  const [left, right, top, bottom] = [8, 8, 15, 25];
  const ahead = Math.max(1500, 2 * length);
  const from = place - length - 0.15 * ahead;
  const to = place + ahead;
  const x = (s) => left + ((s - from) / (to - from)) * (width - left - right);
  const heightAt = (s) => {
    const row = profile.findLast((item) => item[0] <= s);
    if (!row) return 0;
    return row[3] + row[2] * 1e-3 * (Math.min(s, row[1]) - row[0]);
  };
  const nodes = [from, ...profile.flatMap((row) => [row[0], row[1]]).filter((s) => s > from && s < to), to].sort((a, b) => a - b);
  const heights = nodes.map(heightAt);
  const middle = (Math.max(...heights) + Math.min(...heights)) / 2;
  const half = Math.max((Math.max(...heights) - Math.min(...heights)) / 2, 4);
  const y = (h) => top + ((middle + half - h) / (2 * half)) * (height - top - bottom);
  ctx.beginPath();
  ctx.moveTo(x(from), height - bottom + 9);
  nodes.forEach((s, place_) => ctx.lineTo(x(s), y(heights[place_])));
  ctx.lineTo(x(to), height - bottom + 9);
  ctx.fillStyle = colour("off");
  ctx.fill();
  ctx.lineWidth = 1.2;
  nodes.slice(1).forEach((s, k) => line(ctx, x(nodes[k]), y(heights[k]), x(s), y(heights[k + 1]), "grey"));
  for (const [start, end, permille] of profile) {
    const [a, b] = [Math.max(x(start), left), Math.min(x(end), width - right)];
    if (start > from && start < to) line(ctx, x(start), y(heightAt(start)) - 4, x(start), height - bottom + 9, "line");
    const isCovered = a < x(place) + 4 && b > x(place - length) && (a + b) / 2 > x(place - length) - 22 && (a + b) / 2 < x(place) + 26;
    if (b - a > 44 && !isCovered) text(ctx, `${permille > 0 ? "+" : ""}${number(permille, 1)} ‰`, (a + b) / 2, y(heightAt((Math.max(start, from) + Math.min(end, to)) / 2)) - 5, "center");
  }
  for (const [start, end, radius, turns] of curves) {
    const [a, b] = [Math.max(x(start), left), Math.min(x(end), width - right)];
    if (b <= a) continue;
    ctx.lineWidth = 2;
    line(ctx, a, height - bottom + 6, b, height - bottom + 6, "green");
    if (b - a > 70) text(ctx, `R ${number(radius, 0)} m ${turns}`, (a + b) / 2, height - bottom + 3, "center", "green");
  }
  drawTrain(ctx, place, length, x, (s) => y(heightAt(s)));
  ctx.lineWidth = 1;
  const { found } = ticks(from, to, Math.max(width / 110, 2));
  for (const tick of found) {
    line(ctx, x(tick), height - 15, x(tick), height - 12, "grey");
    text(ctx, `${number(tick, 0)} m`, Math.min(Math.max(x(tick), 22), width - 24), height - 3, "center");
  }
}

function drawTrain(ctx, place, length, x, y) {
  ctx.strokeStyle = colour("blue");
  ctx.lineWidth = 5;
  ctx.lineCap = "butt";
  ctx.beginPath();
  const pieces = 24;
  for (let k = 0; k <= pieces; k += 1) {
    const s = place - length + (length * k) / pieces;
    ctx.lineTo(x(s), y(s) - 3);
  }
  ctx.stroke();
  ctx.fillStyle = colour("vermilion");
  ctx.beginPath();
  ctx.arc(x(place), y(place) - 3, 3.6, 0, 2 * Math.PI);
  ctx.fill();
}

// Rows above the `highest` level have no number: the one there is counts emergency.
export function drawHeat(canvas, heat, name, highest) {
  const { ctx, width, height } = begin(canvas);
  const [left, right, top, bottom] = [22, 6, 4, 14];
  const rows = heat.rows.length;
  const columns = Math.max(heat.rows[0]?.length ?? 0, 8);
  const most = Math.max(...heat.rows.flat(), 0);
  const wide = (width - left - right) / columns;
  const high = (height - top - bottom) / rows;
  ctx.fillStyle = colour("off");
  ctx.fillRect(left, top, width - left - right, height - top - bottom);
  ctx.fillStyle = colour(name);
  heat.rows.forEach((row, level) =>
    row.forEach((frequency, column) => {
      if (frequency <= 0) return;
      ctx.globalAlpha = 0.12 + 0.88 * Math.sqrt(frequency / most); // rare cells stay visible
      ctx.fillRect(left + column * wide, top + (rows - 1 - level) * high, wide + 0.3, high + 0.3);
    }),
  );
  ctx.globalAlpha = 1;
  const every = Math.max(tickStep(rows, Math.max((height - 18) / 15, 1)), 1);
  const label = (level, words) => text(ctx, words, left - 4, top + (rows - level - 0.5) * high + 3.5, "right");
  const isTold = highest > 0 && rows - 1 > highest;
  for (let level = 0; level < rows; level += every) {
    if (!isTold || level <= highest && (rows - 1 - level) * high > 8) label(level, String(level));
  }
  if (isTold) label(rows - 1, "E");
  if (most <= 0) nothing(ctx, (left + width - right) / 2, (height - bottom + top) / 2);
  ticksBelow(ctx, heat.lowest, heat.lowest + columns * heat.width, left, width - right, height - 3);
  return most;
}

export function drawBars(canvas, histogram, name, logarithmic = false) {
  const { ctx, width, height } = begin(canvas);
  const [left, right, top, bottom] = [26, 6, 5, 14];
  const { bars, lowest, width: bin } = histogram;
  if (!bars.length) {
    nothing(ctx, width / 2, height / 2);
    return;
  }
  const most = Math.max(...bars, 1e-12);
  const floor = 0.3; // below half a cycle on a logarithmic axis
  const part = (value) => (logarithmic ? Math.log(Math.max(value, floor) / floor) / Math.log(Math.max(most, 1) * 1.2 / floor) : value / most);
  const y = (value) => height - bottom - part(value) * (height - top - bottom);
  const counts = most < 12 ? [0.5, 1, 2, 5, 10] : [1, 10, 100, 1000, 10000, 100000];
  const shown = logarithmic ? counts.filter((tick) => tick <= most) : [0, most];
  ctx.lineWidth = 0.7;
  for (const tick of shown) {
    line(ctx, left, y(tick), width - right, y(tick), "pale");
    text(ctx, logarithmic ? String(tick) : number(tick, 2), left - 3, y(tick) + (tick === most && !logarithmic ? 7 : 3), "right");
  }
  const count = Math.max(bars.length, 4);
  const wide = (width - left - right) / count;
  ctx.fillStyle = colour(name);
  bars.forEach((value, k) => value > 0 && ctx.fillRect(left + k * wide, y(value), Math.max(wide - 0.7, 0.7), height - bottom - y(value)));
  ticksBelow(ctx, lowest, lowest + count * bin, left, width - right, height - 3);
}

function nothing(ctx, x, y) {
  text(ctx, "nothing yet", x, y, "center");
}

function ticksBelow(ctx, low, high, left, right, y) {
  const { found, decimals } = ticks(low, high, Math.max((right - left) / 45, 2));
  for (const tick of found) {
    const x = left + ((tick - low) / (high - low)) * (right - left);
    text(ctx, number(tick, decimals), Math.min(x, right - 8), y, "center");
  }
}
