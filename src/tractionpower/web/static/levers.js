// The driver's desk: levers with their keys, electric and independent brake, what other keys do.
import { number } from "./charts.js";
import { at, button, make, write } from "./page.js";

const MOST_NOTCHES = 16; // levels of the electric brake that have a button each, in two rows; more have a slider
const MANY = 20; // levels of a lever beyond which they are written smaller
const TITLES = { drive: "Drive u₁", brake: "Brake u₂" };

export function makeLevers(hello, labels, send) {
  for (const control of ["drive", "brake"]) makeLever(hello, control, labels, send);
  if (hello.highest.electric > 0) makeElectric(hello.highest.electric, labels, send);
  if (hello.independent) makeIndependent(hello.highest_bar, send);
  makeHints(labels);
}

function makeLever(hello, control, labels, send) {
  const lever = make("div", "", `lever ${control}`);
  const head = make("h2", TITLES[control]);
  const value = make("b", "0");
  value.id = `lever-${control}`;
  head.append(value);
  const highest = Math.max(hello.highest[control], 15);
  const notches = make("div", "", highest > MANY ? "notches many" : "notches");
  const keyOf = Object.fromEntries(
    Object.entries(hello.keys.keys).filter(([, order]) => order.set === control).map(([code, order]) => [order.level, labels[code]]),
  );
  for (let level = highest; level >= 0; level -= 1) {
    const made = button(String(level), () => send({ set: control, level }));
    made.append(make("kbd", keyOf[level] ?? ""));
    made.dataset.level = level;
    made.disabled = level > hello.highest[control];
    notches.append(made);
  }
  lever.append(head, notches);
  at("levers").append(lever);
}

function makeElectric(highest, labels, send) {
  const place = at("electric");
  const head = make("div", "", "label");
  const value = make("b", "0");
  value.id = "lever-electric";
  head.append(make("span", "Electric brake"), value);
  place.append(head);
  if (highest < MOST_NOTCHES) {
    const notches = make("div", "", "notches");
    notches.style.gridTemplateColumns = `repeat(${Math.ceil((highest + 1) / 2)}, minmax(0, 1fr))`;
    for (let level = 0; level <= highest; level += 1) {
      const made = button(String(level), () => send({ set: "electric", level }));
      made.dataset.level = level;
      notches.append(made);
    }
    place.append(notches);
  } else {
    place.append(slider("Electric brake", { max: highest, step: 1 }, (level) => send({ set: "electric", level })));
  }
  const hint = make("div", "", "hint");
  hint.append(make("kbd", labels.KeyU), " less, ", make("kbd", labels.KeyI), " more");
  place.append(hint);
  place.hidden = false;
}

function makeIndependent(highestBar, send) {
  const place = at("independent");
  const head = make("div", "", "label");
  const value = make("b", "0.0 bar");
  head.append(make("span", "Independent brake"), value);
  const set = (bar) => { value.textContent = `${number(bar, 1)} bar`; send({ set: "independent", bar }); };
  place.append(head, slider("Independent brake", { max: highestBar, step: 0.1 }, set));
  place.hidden = false;
}

function slider(words, range, act) {
  const made = Object.assign(document.createElement("input"), { type: "range", min: 0, value: 0, ...range });
  made.setAttribute("aria-label", words);
  made.addEventListener("input", () => act(made.valueAsNumber));
  made.addEventListener("change", () => made.blur());
  return made;
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

// Shows where the levers stand. Emergency is counted as a level above the highest of the brake: there is no such level to set.
export function markLevers(hello, snapshot, levels) {
  const isEmergency = snapshot.brake > hello.highest.brake;
  for (const control of ["drive", "brake"]) {
    const level = Math.min(snapshot[control] ?? 0, hello.highest[control]);
    const isBeyond = control === "brake" && isEmergency;
    write(`lever-${control}`, isBeyond ? "E" : String(level));
    document.querySelectorAll(`.lever.${control} .notches button`).forEach((made) => {
      const its = Number(made.dataset.level);
      made.classList.toggle("now", its === level && !isBeyond);
      made.classList.toggle("lit", its > 0 && (its < level || isBeyond));
    });
  }
  at("lever-brake").title = isEmergency ? "emergency" : "";
  at("lever-brake").classList.toggle("emergency", isEmergency);
  at("emergency").classList.toggle("now", isEmergency);
  if (hello.highest.electric > 0) markElectric(levels.electric);
}

function markElectric(level) {
  write("lever-electric", String(level));
  document.querySelectorAll("#electric button").forEach((made) => made.classList.toggle("now", Number(made.dataset.level) === level));
  const its = at("electric").querySelector("input");
  if (its && its !== document.activeElement) its.value = level;
}
