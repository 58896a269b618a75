// The page of the teacher: who is there, what is played, everybody's shots.

const COLOURS = ["#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00"]; // Okabe and Ito
const LIGHT = ["#56B4E9", "#E69F00", "#2BB673", "#CC79A7", "#F0E442", "#FF8A5B"]; // on a dark place
const BARS = 16;
const ACTIVE = 45, ASKED = 5000; // s since the last message of who is active; ms after which the room is asked for again

const state = { source: "", changes: {}, scene: null, stage: null, run: null, room: { players: [], rows: [] } };
let board = null, wire, ask, settings;
const present = { number: 0, stage: null, player: null };

const colourOf = (number) => (state.stage?.dark ? LIGHT : COLOURS)[(number - 1) % COLOURS.length];

/** Everybody's last shots, on the place of the scene; nothing is played. */
class Board extends Player {
  controls() {}
  keys() {}
  pointer() {}
  timeline() {}
  now() {}

  heading() {}

  resized() {
    super.resized();
    this.canvas.style.setProperty("--ratio", this.across[0] / this.across[1]);
  }

  draw() {
    const { context } = this;
    this.onLayer(this.canvas.width / this.across[0]);
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

/** One shot, for all to see: it plays by itself, and again. */
class Show extends Board {
  constructor(data) {
    super(data, $("shown"));
    this.hint.remove();
  }

  draw() {
    Player.prototype.draw.call(this);
  }

  verdict(word) {
    $("presented-title").dataset.verdict = word || $("presented-title").dataset.verdict;
  }

  /** Take a shot and play it. */
  watch(data) {
    this.load(data);
    this.resized();
    this.seek(0);
    this.play();
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
  const asked = JSON.stringify([state.source, state.seen, room()]);
  if (asked !== state.asked) ask.stage.ask({ changes: state.seen, room: room() });
  state.asked = asked;
}

const heard = {
  welcome({ scenes }) {
    fillScenes($("scene"), scenes);
    state.titles = new Map(scenes.map(([source, , kind, , title]) => [source, kind === "task" || kind === "game" ? title : source]));
    give(scenes);
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
    ask.path.ask({ changes: state.changes, room: room() });
    [state.seen, state.asked] = [state.changes, ""];
    askStage();
    shown();
  },
  async stage({ n, stage }) {
    if (n === present.n) return (present.stage = await staged(stage));
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
  shot({ n, run }) {
    if (n === present.n && present.stage) play(run);
  },
  room(now) {
    state.room = now;
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

const minutes = (seconds) => (seconds < 90 ? `${seconds} s` : `${Math.round(seconds / 60)} min`);

const named = (source) => state.titles?.get(source) ?? source;

/** Players, small pictures, table and histogram. */
function shown() {
  if (!state.room.lead) return;
  const { lead, players, rows } = state.room, here = players.filter((each) => each.here);
  $("freeze").setAttribute("aria-pressed", lead.frozen);
  $("freeze").textContent = lead.frozen ? "Go on" : "Freeze";
  $("predict").value = lead.predict;
  $("led").textContent = lead.source ? `All play ${named(lead.source)}.` : "Everybody chooses.";
  const active = here.filter(({ quiet }) => quiet < ACTIVE).length;
  $("count").textContent = `${here.length} here, ${active} active, ${players.length - here.length} left · ${counted(rows.length)}`;
  for (const button of $("given").querySelectorAll("button")) button.setAttribute("aria-pressed", button.dataset.source === lead.source);
  $("players").replaceChildren(...[...here, ...players.filter((each) => !each.here)].map((each) => {
    const item = cell("li", "", each.here ? "" : "away"), dot = document.createElement("i"), name = cell("button", each.name);
    dot.style.background = colourOf(each.number);
    name.type = "button";
    name.title = "only these shots";
    name.addEventListener("click", () => (($("whose").value = each.number), shown()));
    const is = !each.here ? `left ${minutes(each.quiet)} ago` : each.quiet < ACTIVE ? "active" : `quiet for ${minutes(each.quiet)}`;
    const task = each.last?.task, score = task ? `${task.total}${task.over ? ` ${"★".repeat(task.stars)}` : ""}` : "";
    const said = [is, each.source ? `in ${named(each.source)}` : "choosing", each.shots ? counted(each.shots) : "", score].filter(Boolean);
    item.append(dot, name, cell("span", ` ${said.join(" · ")}`));
    return item;
  }));
  filters(rows);
  small(filtered(rows));
  table(rows.filter(({ player }) => !$("whose").value || player === Number($("whose").value)));
  if (state.stage) board?.draw();
}

/** Scenes and players that have shots, with how many. */
function filters(rows) {
  const fill = (list, all, entries) => {
    const { value } = list, options = [new Option(`${all} (${rows.length})`, ""), ...entries];
    if (list.options.length === options.length && options.every(({ text }, i) => list.options[i].text === text)) return;
    list.replaceChildren(...options);
    list.value = [...list.options].some((each) => each.value === value) ? value : "";
  };
  const count = (key) => rows.reduce((by, row) => by.set(row[key], (by.get(row[key]) ?? 0) + 1), new Map());
  const names = new Map(rows.map(({ player, name }) => [player, name]));
  fill($("which"), "all", [...count("scene")].map(([source, number]) => new Option(`${named(source)} (${number})`, source)));
  fill($("whose"), "all", [...count("player")].map(([player, number]) => new Option(`${names.get(player)} (${number})`, player)));
}

/** The rows that are asked for, the newest first. */
function filtered(rows) {
  const [which, whose, good] = [$("which").value, Number($("whose").value), $("good").checked];
  return rows.filter((row) => (!which || row.scene === which) && (!whose || row.player === whose) && (!good || row.scored)).reverse();
}

/** Small pictures of shots; each is asked for once it comes into sight. */
function small(rows) {
  const known = new Map([...$("small").children].map((item) => [item.dataset.number, item]));
  $("found").textContent = counted(rows.length);
  $("small").replaceChildren(...rows.map((row) => known.get(String(row.number)) ?? pictured(row)));
}

function pictured({ number, name, scene, verdict, scored }) {
  const item = cell("li", ""), button = cell("button", ""), image = Object.assign(new Image(320, 180), { loading: "lazy", alt: "" });
  item.dataset.number = number;
  image.addEventListener("error", () => { // it is not drawn yet
    image.removeAttribute("src");
    setTimeout(() => (image.src = `shot-${number}.webp?${Date.now()}`), ASKED);
  });
  image.src = `shot-${number}.webp`;
  button.type = "button";
  button.append(image, cell("b", name), cell("span", verdict, scored ? "good" : ""), cell("em", named(scene)));
  button.addEventListener("click", () => showcase(number));
  item.append(button);
  return item;
}

/** Show another scene here, and its shots. */
const see = (source) => wire.send({ do: "see", source });

/** Buttons that give a task, a game or a scene to all, by sport. */
function give(scenes) {
  const groups = new Map();
  for (const [source, about, kind, sport, title] of scenes) {
    if (kind === "preset") continue;
    if (!groups.has(sport)) {
      const group = document.createElement("details");
      group.append(cell("summary", sport));
      groups.set(sport, group);
    }
    const button = Object.assign(cell("button", kind === "scene" ? "Just play" : kind === "game" ? `${title}, two by two` : title), { type: "button", title: about });
    button.dataset.source = source;
    button.addEventListener("click", () => wire.send({ do: "lead", source, changes: {} }));
    groups.get(sport).append(button);
  }
  $("given").replaceChildren(...groups.values());
  if ($("given").firstChild) $("given").firstChild.open = true;
}

// ------------------------------------------------------------------------------------------------ one for all to see

/** Present a shot. */
function showcase(number) {
  const row = state.room.rows.find((each) => each.number === number);
  if (!row) return;
  if (!$("presented").open) $("presented").showModal();
  Object.assign(present, { number, stage: null, n: ++Latest.number });
  $("presented-title").textContent = `${row.name}: ${named(row.scene)}`;
  $("presented-title").dataset.verdict = "";
  $("presenting").hidden = false;
  const box = $("shown").parentElement;
  wire.send({ do: "present", n: present.n, number, room: [box.clientWidth, parseFloat(getComputedStyle(box).maxHeight)].map((size) => Math.max(100, Math.round(size))) });
}

function play(run) {
  const row = state.room.rows.find(({ number }) => number === present.number);
  const data = onStage(present.stage, run, []);
  present.player ??= new Show(data);
  $("presenting").hidden = true;
  present.player.watch(data);
  $("presented-title").textContent = `${row?.name ?? ""}: ${run.verdict}`;
  $("presented-title").dataset.verdict = run.good ? "good" : "";
}

/** The shot so many places on in the list. */
function along(by) {
  const numbers = filtered(state.room.rows).map(({ number }) => number), place = numbers.indexOf(present.number) + by;
  if (numbers[place] !== undefined) showcase(numbers[place]);
}

// ------------------------------------------------------------------------------------------------ the class in numbers

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
  const mean = values.reduce((sum, each) => sum + each, 0) / values.length, sorted = [...values].sort((a, b) => a - b);
  const spread = Math.sqrt(values.reduce((sum, each) => sum + (each - mean) ** 2, 0) / (values.length - 1));
  const scored = known.filter((row) => row.scored).length, [middle] = sorted.slice(values.length >> 1);
  $("bars-title").textContent = values.length
    ? `${named(state.source)}: ${counted(values.length)}, ${scored} successes; mean ${number(mean)} ${fact.unit}, median ${number(middle)}, standard deviation ${values.length > 1 ? number(spread) : "–"}`
    : `no shots of ${named(state.source)} yet`;
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
  $("fact").addEventListener("change", shown);
  $("which").addEventListener("change", () => ($("which").value && see($("which").value), shown()));
  for (const name of ["whose", "good"]) $(name).addEventListener("change", shown);
  $("earlier").addEventListener("click", () => along(1));
  $("later").addEventListener("click", () => along(-1));
  $("replay").addEventListener("click", () => present.player && (present.player.seek(0), present.player.playing || present.player.play()));
  $("close").addEventListener("click", () => $("presented").close());
  $("presented").addEventListener("close", () => present.player && (present.player.playing = false));
  setInterval(() => wire.send({ do: "look" }), ASKED);
  addEventListener("resize", () => {
    if (state.stage && !fits(state.stage)) waiting("Turning the picture ...");
    shown();
    askStage();
  });
}

begin();
