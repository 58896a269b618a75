// The parameters of a scene, each with a slider, a list of words or a switch, made from what the scene declares.

/** A key for people: "launch.speed" is "launch speed", "air.wind[0]" is "air wind x", "mills[0].rate" is "mills 1 rate". */
const labelOf = (key) => key.replace(/\[(\d+)\](?=$)/, (_, i) => ` ${"xyz"[i] ?? i}`).replace(/\[(\d+)\]/, (_, i) => ` ${Number(i) + 1}`).replace(/[._]/g, " ");

/** A unit for people: "m/s^2" is "m/s²". */
const unitOf = (unit) => unit.replace("^2", "²").replace("^3", "³");

/** A number as it is typed: six figures. */
const typed = (value) => String(Number(Number(value).toPrecision(6)));

class Settings {
  /** `changed(key, value)` is called when the player changes one. */
  constructor(first, rest, changed) {
    Object.assign(this, { first, rest, changed, rows: new Map(), changes: {} });
  }

  /** Show these parameters, as they are in the scene. */
  build(parameters) {
    this.rows.clear();
    const groups = new Map();
    this.first.replaceChildren(...parameters.filter(({ first }) => first).map((each) => this.row(each)));
    for (const each of parameters.filter(({ first }) => !first)) {
      const group = labelOf(each.key.includes(".") ? each.key.slice(0, each.key.lastIndexOf(".")) : "scene");
      if (!groups.has(group)) groups.set(group, []);
      groups.get(group).push(this.row(each));
    }
    this.rest.replaceChildren(...[...groups].map(([name, rows]) => {
      const field = document.createElement("fieldset"), legend = document.createElement("legend");
      legend.textContent = name;
      field.append(legend, ...rows);
      return field;
    }));
    this.rest.parentElement.hidden = !groups.size;
  }

  row(parameter) {
    const { key, unit, meaning, choices } = parameter, row = document.createElement("div");
    row.className = "setting";
    row.title = [meaning, choices ? "" : `from ${typed(parameter.low)} to ${typed(parameter.high)} ${unit}`].filter(Boolean).join("; ");
    const label = document.createElement("label");
    label.textContent = labelOf(key);
    label.htmlFor = `set-${key}`;
    const reset = Object.assign(document.createElement("button"), { type: "button", textContent: "×", className: "reset" });
    reset.setAttribute("aria-label", `${labelOf(key)} as in the scene`);
    reset.addEventListener("click", () => this.take(key, parameter.value));
    const made = choices ? this.words(parameter) : this.number(parameter);
    row.append(label, ...made.parts, reset);
    this.rows.set(key, { row, reset, parameter, show: made.show });
    made.show(parameter.value);
    return row;
  }

  number({ key, unit, low, high, span, value }) {
    const field = Object.assign(document.createElement("input"), { type: "number", id: `set-${key}`, min: low, max: high, step: "any" });
    const name = Object.assign(document.createElement("span"), { className: "unit", textContent: unitOf(unit) });
    const take = (text) => {
      const number = Number(text);
      if (text === "" || !Number.isFinite(number)) return this.rows.get(key).show(this.value(key));
      this.take(key, Math.min(high, Math.max(low, number)));
    };
    field.addEventListener("change", () => take(field.value));
    const parts = [field, name];
    let slider = null;
    if (span) {
      slider = Object.assign(document.createElement("input"), { type: "range", min: span[0], max: span[1], step: "any", value });
      slider.setAttribute("aria-label", `${labelOf(key)}${unit ? ` in ${unitOf(unit)}` : ""}`);
      slider.addEventListener("input", () => this.take(key, Number(Number(slider.value).toPrecision(4))));
      slider.addEventListener("keydown", (event) => this.step(event, key, span));
      parts.push(slider);
    }
    return { parts, show: (now) => {
      field.value = typed(now);
      if (slider) [slider.value, slider.ariaValueText] = [now, `${typed(now)} ${unitOf(unit)}`];
    } };
  }

  /** A hundredth of a slider by an arrow key; a thousandth with Shift. */
  step(event, key, [low, high]) {
    const by = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1 }[event.key];
    if (!by) return;
    event.preventDefault();
    const { parameter } = this.rows.get(key), step = (by * (high - low)) / (event.shiftKey ? 1000 : 100);
    this.take(key, Number(Math.min(parameter.high, Math.max(parameter.low, this.value(key) + step)).toPrecision(6)));
  }

  words({ key, choices }) {
    if (choices.every((word) => typeof word === "boolean")) {
      const box = Object.assign(document.createElement("input"), { type: "checkbox", id: `set-${key}` });
      box.addEventListener("change", () => this.take(key, box.checked));
      return { parts: [box], show: (now) => (box.checked = now) };
    }
    const list = Object.assign(document.createElement("select"), { id: `set-${key}` });
    for (const word of choices.filter((each) => each !== null)) list.add(new Option(word, word));
    list.addEventListener("change", () => this.take(key, list.value));
    return { parts: [list], show: (now) => (list.value = now) };
  }

  value(key) {
    const row = this.rows.get(key);
    return key in this.changes ? this.changes[key] : row?.parameter.value;
  }

  take(key, value) {
    this.changed(key, value);
  }

  /** Show the scene with these changes. */
  show(changes) {
    this.changes = changes;
    for (const [key, { row, reset, parameter, show }] of this.rows) {
      const value = key in changes ? changes[key] : parameter.value, same = value === parameter.value;
      show(value);
      row.classList.toggle("changed", !same);
      reset.disabled = same;
    }
  }
}

/** Change a parameter; what is as in the scene is no change. */
function change({ scene, changes }, key, value) {
  if (scene.by.get(key)?.value === value) delete changes[key];
  else changes[key] = value;
}

/** What a player has changed, besides what every pull sets: each key with its value as text. */
function changedBy(changes, scene) {
  const own = Object.entries(changes).filter(([key]) => !(key in (scene.pull?.sets ?? {})));
  return own.map(([key, value]) => [key, typeof value === "number" ? typed(value) : value]);
}

/** The list of all that may be played, by sport. */
function fillScenes(list, scenes) {
  const groups = new Map();
  for (const [name, about, kind, sport, title] of scenes) {
    if (!groups.has(sport)) groups.set(sport, Object.assign(document.createElement("optgroup"), { label: sport }));
    groups.get(sport).append(Object.assign(new Option(kind === "task" || kind === "game" ? `${kind}: ${title}` : name, name), { title: about }));
  }
  list.replaceChildren(...(groups.size === 1 ? [...groups.values()][0].children : groups.values()));
}
