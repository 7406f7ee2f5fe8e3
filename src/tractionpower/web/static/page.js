// What every part of the page uses. Texts are never read as HTML.

export const at = (id) => document.getElementById(id);
export const make = (tag, words = "", className = "") => Object.assign(document.createElement(tag), { textContent: words, className });
export const write = (id, words) => { const place = at(id); if (place.textContent !== words) place.textContent = words; };

// A button keeps no focus: Space and Enter are keys of the train.
export function button(words, act, title = "") {
  const made = make("button", words);
  made.type = "button";
  made.title = title;
  onClick(made, act);
  return made;
}

export function onClick(made, act) {
  made.addEventListener("click", (event) => { act(event); made.blur(); });
}

// Writes into an element of its own, for it covers nothing.
export function say(words) {
  write("banner", words);
  at("banner").title = words;
}

let timer = 0;
export function notify(words) {
  write("notice", words);
  at("notice").hidden = false;
  clearTimeout(timer);
  timer = setTimeout(() => { at("notice").hidden = true; }, 4000);
}
