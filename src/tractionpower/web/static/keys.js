// The keyboard: keys by their place (KeyboardEvent.code), as the program has mapped them; letters as this keyboard has them.

const PLAIN = {
  ArrowUp: "↑", ArrowDown: "↓", ArrowLeft: "←", ArrowRight: "→", Comma: ",", Period: ".", Space: "Space", Enter: "Enter",
};

export function listenToKeys(keys, send) {
  const orderOf = (event) => (event.ctrlKey || event.altKey || event.metaKey ? undefined : keys[event.code]);
  addEventListener("keydown", (event) => {
    const order = orderOf(event);
    if (!order) return;
    event.preventDefault();
    // A key held down repeats: that moves a lever on, and must not send the same level again and again.
    if (!event.repeat || "step" in order) send(order);
  });
  // Space and Enter would press the button that was clicked last.
  addEventListener("keyup", (event) => orderOf(event) && event.preventDefault());
}

export async function keyLabels(keys) {
  let layout = null;
  try {
    layout = await navigator.keyboard?.getLayoutMap();
  } catch {
    layout = null; // not every browser tells
  }
  const label = (code) => PLAIN[code] ?? (layout?.get(code) ?? code.replace(/^(Key|Digit)/, "")).toUpperCase();
  return Object.fromEntries(Object.keys(keys).map((code) => [code, label(code)]));
}
