// The page of the teacher: who is there, what is played, everybody's shots.

const COLOURS = ["#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00"]; // Okabe and Ito
const LIGHT = ["#56B4E9", "#E69F00", "#2BB673", "#CC79A7", "#F0E442", "#FF8A5B"]; // on a dark place
const BARS = 16;

const state = { source: "", changes: {}, scene: null, stage: null, run: null, room: { players: [], rows: [] } };
let board = null, wire, ask, settings;

const colourOf = (number) => (state.stage?.dark ? LIGHT : COLOURS)[(number - 1) % COLOURS.length];

/** Everybody's last shots, on the place of the scene; nothing is played. */
class Board extends Player {
  controls() {}
  keys() {}
  pointer() {}
  timeline() {}
  now() {}

  draw() {
    const { context } = this, density = this.canvas.width / this.view.size[0];
    context.setTransform(density, 0, 0, density, 0, 0);
    context.drawImage(this.view.place, 0, 0);
    this.t = 0;
    for (const ball of this.data.balls) this.ball(ball, 0);
    context.drawImage(this.view.over, 0, 0);
    const shots = state.room.players.filter(({ last }) => last && last.source === state.source);
    if (this.view.lens) {
      this.lens(() => {
        for (const ball of this.data.balls) this.ball(ball, 0);
        for (const each of shots) this.shot(each);
      });
    }
    const ends = shots.map((each) => [each, this.shot(each)]).filter(([, end]) => end).sort(([, a], [, b]) => b[1] - a[1]);
    this.taken = []; // by names
    for (const [{ name, number }, [x, y]] of ends) {
      this.label(name, x, y - 8 * this.view.unit, "#f4f6f8", this.taken, colourOf(number));
      this.disc(x, y, 4 * this.view.unit, colourOf(number));
    }
  }

  /** Draw the path of a shot; returns where it ends, if it has one. */
  shot({ number, last: { line } }) {
    const points = this.places(line);
    this.trace(points, 0, Infinity, 3 * this.view.unit, colourOf(number), 0.9, this.view.unit);
    return points[points.length - 1];
  }

  places(line) {
    const points = [];
    for (let i = 0; i < line.length; i += 2) points.push([...this.spot(this.main, line[i], line[i + 1]), i]);
    return points;
  }

  /** How far a line leaves the picture, as a share of it. */
  beyond(line) {
    return Math.max(0, ...this.places(line).flatMap((at) => this.view.size.map((size, axis) => Math.max(-at[axis], at[axis] - size) / size)));
  }
}

/** Ask for the place as it is seen from where a shot is in sight with speed and angle of the one that leaves it the most. */
function askStage() {
  if (!state.scene) return;
  const shots = board ? state.room.players.filter(({ last }) => last?.source === state.source) : [];
  const [most, far] = shots.map((each) => [board.beyond(each.last.line), each]).sort(([a], [b]) => b - a)[0] ?? [0];
  const row = most > 0 ? state.room.rows.findLast((each) => each.player === far.number && each.scene === state.source) : null;
  const { speed, angle } = state.scene.pull ?? {}, set = Object.entries(row?.changes ?? {}).filter(([key]) => key === speed || key === angle);
  if (row) state.seen = { ...state.changes, ...Object.fromEntries(set) };
  const asked = JSON.stringify([state.source, state.seen, narrow()]);
  if (asked !== state.asked) ask.stage.ask({ changes: state.seen, narrow: narrow() });
  state.asked = asked;
}

const heard = {
  welcome({ scenes }) {
    fillScenes($("scene"), scenes);
  },
  scene(scene) {
    const another = scene.source !== state.source;
    if (another) waiting(`Loading ${scene.title} ...`);
    Object.assign(state, { source: scene.source, changes: { ...scene.changes }, scene, stage: null, run: null });
    scene.by = new Map(scene.parameters.map((each) => [each.key, each]));
    $("scene").value = scene.source;
    settings.build(scene.parameters);
    settings.show(state.changes);
    if (another) {
      const options = (first) => [...first, ...scene.facts.map(({ key, label, unit }) => new Option(`${label} (${unit})`, key))];
      $("fact").replaceChildren(...options([]));
      $("predict").replaceChildren(...options([new Option("nothing", "")]));
    }
    for (const each of Object.values(ask)) each.forget();
    ask.path.ask({ changes: state.changes });
    [state.seen, state.asked] = [state.changes, ""];
    askStage();
    shown();
  },
  async stage({ n, stage }) {
    if (!ask.stage.answered(n)) return;
    state.stage = await staged(stage);
    document.querySelector(".picture").classList.toggle("dark", stage.dark);
    show();
    shown();
  },
  path({ n, run }) {
    if (!ask.path.answered(n)) return;
    state.run = run;
    show();
  },
  room(room) {
    state.room = room;
    shown();
    askStage();
  },
  error({ text }) {
    $("told").textContent = text;
    $("told").hidden = false;
    if (!state.stage || !state.run) waiting(text);
    clearTimeout(state.clearing);
    state.clearing = setTimeout(() => ($("told").hidden = true), 6000);
  },
};

function show() {
  if (!state.stage || !state.run) return;
  const data = onStage(state.stage, state.run, []);
  if (!board) window.board = board = new Board(data);
  board.load(data);
  board.resized();
  waiting("");
}

const cell = (kind, text, name = "") => Object.assign(document.createElement(kind), { textContent: text, className: name });

const counted = (shots) => `${shots} ${shots === 1 ? "shot" : "shots"}`;

/** Players, table and histogram. */
function shown() {
  if (!state.room.lead) return;
  const { lead, players, rows } = state.room, here = players.filter((each) => each.here);
  $("freeze").setAttribute("aria-pressed", lead.frozen);
  $("freeze").textContent = lead.frozen ? "Go on" : "Freeze";
  $("predict").value = lead.predict;
  $("led").textContent = lead.source ? `All play ${lead.source}.` : "Everybody chooses a scene.";
  $("count").textContent = `${here.length}`;
  $("players").replaceChildren(...players.map((each) => {
    const item = cell("li", "", each.here ? "" : "away"), dot = document.createElement("i");
    dot.style.background = colourOf(each.number);
    item.append(dot, each.name, cell("span", ` ${each.shots ? counted(each.shots) : ""}${each.last?.task ? `, ${each.last.task.total}${each.last.task.over ? ` ${"★".repeat(each.last.task.stars)}` : ""}` : ""}${each.source === state.source ? "" : `, in ${each.source}`}${each.here ? "" : ", away"}`));
    return item;
  }));
  elsewhere(rows);
  table(rows);
  if (state.stage) board?.draw();
}

/** Which other scenes have shots, each with a button that shows them. */
function elsewhere(rows) {
  const by = new Map();
  for (const { scene } of rows) if (scene !== state.source) by.set(scene, (by.get(scene) ?? 0) + 1);
  $("others").hidden = !by.size;
  $("others").replaceChildren("In other scenes: ", ...[...by].flatMap(([source, count]) => {
    const button = cell("button", `${source}: ${counted(count)}`);
    button.type = "button";
    button.addEventListener("click", () => see(source));
    return [button, " "];
  }));
}

/** Show another scene here, and its shots. */
const see = (source) => wire.send({ do: "see", source });

function table(rows) {
  const { scene } = state, fact = scene?.facts.find(({ key }) => key === $("fact").value);
  if (!fact) return;
  const number = (value) => (typeof value === "number" ? String(Number(value.toPrecision(4))) : "–");
  const own = rows.filter((row) => row.scene === state.source), predicted = own.some((row) => row.predicted !== null);
  const head = document.createElement("tr");
  const more = predicted ? [cell("th", "predicted", "number"), cell("th", "off by", "number")] : [];
  head.append(cell("th", "#", "number"), cell("th", "name"), cell("th", `${fact.label} (${fact.unit})`, "number"), ...more, cell("th", "what happened"), cell("th", "changed"));
  $("shots").tHead.replaceChildren(head);
  $("shots").tBodies[0].replaceChildren(...[...own].reverse().map((row) => {
    const line = document.createElement("tr"), value = row.facts[row.fact || fact.key];
    const guess = predicted ? [cell("td", number(row.predicted), "number"), cell("td", row.predicted === null || value === undefined ? "–" : number(row.predicted - value), "number")] : [];
    const changed = changedBy(row.changes, scene).map(([key, text]) => `${labelOf(key)} ${text}`);
    line.append(cell("td", row.number, "number"), cell("td", row.name), cell("td", number(row.facts[fact.key]), "number"), ...guess, cell("td", row.verdict), cell("td", changed.join(", ")));
    return line;
  }));
  const known = own.filter((row) => typeof row.facts[fact.key] === "number"), values = known.map((row) => row.facts[fact.key]);
  const low = Math.min(...values), high = Math.max(...values), good = Array(BARS).fill(0), rest = Array(BARS).fill(0);
  known.forEach((row, i) => {
    const bar = high > low ? Math.min(BARS - 1, Math.floor(((values[i] - low) / (high - low)) * BARS)) : BARS >> 1;
    (row.scored ? good : rest)[bar] += 1;
  });
  const mean = values.reduce((sum, each) => sum + each, 0) / values.length;
  $("bars-title").textContent = values.length ? `${fact.label}: ${counted(values.length)}, mean ${number(mean)} ${fact.unit}` : "no shots yet";
  drawBars($("bars"), good, rest, values.length ? [`${number(low)} ${fact.unit}`, `${number(high)} ${fact.unit}`] : ["", ""]);
}

function begin() {
  settings = new Settings($("sliders"), $("rest"), (key, value) => {
    change(state, key, value);
    settings.show(state.changes);
  });
  wire = new Wire(() => ({ do: "hello" }), heard);
  ask = Object.fromEntries(["path", "stage"].map((kind) => [kind, new Latest(wire, kind)]));
  $("lead").addEventListener("click", () => {
    const source = $("scene").value;
    wire.send({ do: "lead", source, changes: source === state.source ? state.changes : {} });
  });
  $("scene").addEventListener("change", () => see($("scene").value));
  $("free").addEventListener("click", () => wire.send({ do: "lead", source: "", changes: {} }));
  $("freeze").addEventListener("click", () => wire.send({ do: "freeze", on: !state.room.lead.frozen }));
  $("predict").addEventListener("change", () => wire.send({ do: "predict", fact: $("predict").value }));
  $("clear").addEventListener("click", () => wire.send({ do: "clear" }));
  $("fact").addEventListener("change", () => table(state.room.rows));
  addEventListener("resize", () => {
    if (state.stage && !fits(state.stage)) waiting("Turning the picture ...");
    shown();
    askStage();
  });
}

begin();
