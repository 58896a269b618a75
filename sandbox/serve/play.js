// The page of a player.

const STILL = 150, SETTLED = 350; // ms without a change, after which the place and the fan are asked for again
const ANEW = 3000; // ms after which a place that could not be computed is asked for again
const READ = 8000; // ms for which what is told of a link, or was refused, stays to be read
const SEEN = 2500; // ms for which the end of a shot stays, before a match goes on
const MOST_COMPARED = 3;

const state = { source: "", changes: {}, scene: null, stage: null, run: null, lead: {}, compared: [], shot: false, name: "", scenes: new Map() };
const names = document.querySelectorAll(".name input"); // on the tiles, and beside a picture
let player = null, wire, ask, settings, timers = {};

// ------------------------------------------------------------------------------------------------ choosing

/** Show the tiles or, of a sport, what can be played in it. */
function choose(sport = "") {
  $("choosing").hidden = false;
  $("game").hidden = true;
  $("to-tiles").hidden = !sport;
  document.querySelector(".tiles").hidden = Boolean(sport);
  let title = "Choose a sport";
  for (const each of document.querySelectorAll(".sport")) {
    each.hidden = each.dataset.sport !== sport;
    if (!each.hidden) title = document.querySelector(`.tiles [data-sport="${CSS.escape(sport)}"] b`).textContent;
  }
  $("chosen").textContent = title;
  document.title = `${title}: sports sandbox`;
}

/** The sport that something belongs to. */
const sportOf = (source) => document.querySelector(`.sport [data-source="${CSS.escape(source)}"]`)?.closest(".sport").dataset.sport ?? source.split("/")[0];

/** Show the picture in place of the tiles: at once the tile of its sport, and a line. */
function opened(source, line) {
  $("choosing").hidden = true;
  $("game").hidden = false;
  const tile = document.querySelector(`.tiles [data-sport="${CSS.escape(sportOf(source))}"] img`);
  $("waiting").style.backgroundImage = tile ? `url("${tile.src}")` : "";
  waiting(line);
}

/** Play a scene, a task or a game. */
function play(source, title = source) {
  localStorage.setItem("started", "true");
  Object.assign(state, { stage: null, run: null, next: null });
  state.wanted = source;
  opened(source, `Loading ${title} ...`);
  wire.send({ do: "play", source, changes: {} });
}

/** Back to the tiles, or to what else can be played in the sport. */
function leave() {
  const sport = sportOf(state.source);
  Object.assign(state, { source: "", wanted: "", scene: null, stage: null, run: null, next: null, shot: false });
  clearTimeout(timers.next);
  wire.send({ do: "play", source: "", changes: {} });
  history.replaceState(null, "", location.pathname);
  choose(document.querySelector(`.sport[data-sport="${CSS.escape(sport)}"]`) ? sport : "");
}

// ------------------------------------------------------------------------------------------------ the address

/** Scene and parameters of a link: #golf?launch.speed=70, or launch.speed=150 mph; none of one that cannot be read. */
function linked(hash) {
  let source = hash.slice(1).split("?")[0];
  const query = hash.slice(source.length + 2), changes = {};
  try {
    source = decodeURIComponent(source);
  } catch {
    return { source: "", changes };
  }
  for (const [key, text] of new URLSearchParams(query || "")) {
    const number = Number(text);
    changes[key] = text === "true" || text === "false" ? text === "true" : text !== "" && Number.isFinite(number) ? number : text;
  }
  return { source, changes };
}

function link() {
  const query = new URLSearchParams(state.changes).toString();
  return `#${state.source.split("/").map(encodeURIComponent).join("/")}${query ? `?${query}` : ""}`;
}

// ------------------------------------------------------------------------------------------------ asking

/** The parameters have changed: aim with them. */
function changed(still = false) {
  if (state.shot) again(false);
  settings.show(state.changes);
  history.replaceState(null, "", link());
  $("link").value = location.href;
  ask.path.ask({ changes: state.changes, room: room() });
  if (player?.fan) player.fan.late = true;
  aimed();
  later("fan", still ? 0 : SETTLED, askFan);
}

/** Do something after so many ms in which it was not asked for again. */
function later(what, wait, action) {
  clearTimeout(timers[what]);
  timers[what] = setTimeout(action, wait);
}

function askStage() {
  state.composedFor = JSON.stringify(state.changes);
  ask.stage.ask({ changes: state.changes, room: room() });
}

function askFan() {
  if ($("fan").checked && !state.shot && !state.lead.predict && !contest()) ask.fan.ask({ changes: state.changes });
}

function set(values) {
  for (const [key, value] of Object.entries(values)) change(state, key, value);
  changed();
}

const value = (key) => (key in state.changes ? state.changes[key] : state.scene.by.get(key)?.value);

/** Speed and angle, as they are aimed. */
function aimed() {
  const { pull, by } = state.scene;
  const text = (key) => {
    const { unit } = by.get(key), number = typed(value(key));
    return unit === "deg" ? `${number}°` : unit ? `${number} ${unitOf(unit)}` : `${labelOf(key)} ${number}`;
  };
  const pulled = pull && (pull.speed in state.changes || pull.angle in state.changes);
  const first = state.scene.place && mine() ? "Drag the ball, then pull back." : "Pull back and let go.";
  $("aimed").textContent = !mine() ? "" : pulled ? `${text(pull.speed)} at ${text(pull.angle)}` : pull ? first : "";
}

// ------------------------------------------------------------------------------------------------ aiming

const within = ({ low, high }, number) => Math.min(high, Math.max(low, number));

/** An angle within its bounds, by whole turns where that helps. */
function turned(parameter, angle) {
  const found = [angle, angle - 360, angle + 360].find((each) => each === within(parameter, each));
  return found ?? within(parameter, angle);
}

/** What is played for: a task or a match; null in a scene. */
const contest = () => state.scene?.task ?? state.scene?.match ?? null;

/** True unless the other one has the next shot of a match. */
const mine = () => !state.scene?.match || (!state.scene.match.over && state.scene.match.turn === state.scene.you);

const rounded = (number, digits) => Number(number.toFixed(digits));

const hands = {
  may: () => Boolean(state.scene?.pull && player && !state.lead.frozen && wire.open && mine() && !(contest() && state.shot) && $("ending").hidden),
  inHand: () => Boolean(state.scene?.place && mine() && !state.shot),
  place([x, y]) {
    const [across, up] = state.scene.place, { by } = state.scene;
    set({ [across]: within(by.get(across), rounded(x, 4)), [up]: within(by.get(up), rounded(y, 4)) });
  },
  /** What a player has seen of a shot: what it came to, and its end. */
  seen(told, over) {
    if (!state.shot) return;
    $("verdict").textContent = told || !contest() ? state.run.verdict : "...";
    if (over) finished();
  },
  pull(share, angle) {
    const { pull, by } = state.scene, place = share * (pull.speeds.length - 1), i = Math.min(Math.floor(place), pull.speeds.length - 2);
    const speed = pull.speeds[i] + (place - i) * (pull.speeds[i + 1] - pull.speeds[i]);
    set({ ...pull.sets, [pull.speed]: within(by.get(pull.speed), Number(speed.toPrecision(4))), [pull.angle]: turned(by.get(pull.angle), rounded(angle, 2)) });
  },
  turn(by) {
    const { pull, by: known } = state.scene;
    set({ ...pull.sets, [pull.angle]: turned(known.get(pull.angle), rounded(value(pull.angle) + by, 3)) });
  },
  push(by) {
    const { pull, by: known } = state.scene;
    set({ ...pull.sets, [pull.speed]: within(known.get(pull.speed), rounded(value(pull.speed) + by * pull.push, 6)) });
  },
  spin(which, by) {
    const spin = state.scene.pull.spins[which], parameter = spin && state.scene.by.get(spin.key);
    if (parameter) set({ ...state.scene.pull.sets, [spin.key]: within(parameter, rounded(value(spin.key) + by * spin.step, 6)) });
  },
  shoot() {
    if (!player || $("shoot").disabled) return;
    if (state.shot) return goOn();
    const message = { changes: state.changes, room: room() };
    if (state.lead.predict) {
      if (!$("prediction").reportValidity()) return;
      state.predicted = message.predicted = Number($("predicted").value);
    }
    ask.shoot.forget();
    ask.shoot.ask(message);
  },
  again: () => again(true),
};

/** Aim again; with `asking` with the same parameters. */
function again(asking) {
  if (state.next) return goOn();
  state.shot = false;
  $("playback").hidden = $("shot-more").hidden = true;
  if (asking) changed(true);
}

// ------------------------------------------------------------------------------------------------ what comes

const heard = {
  welcome({ session, name, scenes }) {
    sessionStorage.setItem("session", session);
    for (const field of names) field.value = name;
    state.name = name;
    state.scenes = new Map(scenes.map(([source, about, kind, sport, title]) => [source, { about, kind, sport, title }]));
    $("sports").hidden = scenes.length === 1;
  },
  name({ name }) {
    state.name = name;
    for (const field of names) if (document.activeElement !== field) field.value = name;
  },
  lead(lead) {
    const before = state.lead;
    state.lead = lead;
    $("sports").disabled = $("leave").disabled = $("next-task").disabled = Boolean(lead.source);
    $("prediction").hidden = !lead.predict;
    if (state.scene) predicting();
    told("frozen", lead.frozen ? "The teacher has stopped the game for a moment." : "");
    mayShoot();
    if (player && state.scene && (before.predict || "") !== lead.predict && !state.shot) changed(true);
    else if (before.frozen && !lead.frozen && state.scene) changed(true);
  },
  scene(scene) {
    const match = scene.match && state.scene?.match && scene.source === state.source;
    if (match) told("partner", scene.there || scene.match.over ? "" : `${scene.match.players[1 - scene.you]} is not there at the moment.`);
    if (match && scene.shots === state.scene.shots && scene.you === state.scene.you) return;
    if (match && state.shot && !scene.match.over && scene.shots) { // once this shot was seen
      state.next = scene;
      if (state.finished === state.run) later("next", SEEN, goOn);
      return;
    }
    if (match && state.shot && scene.match.over) return (state.scene.match = scene.match), (state.scene.shots = scene.shots), ending();
    const other = state.source !== scene.source || contest() || scene.task || scene.match;
    Object.assign(state, { source: scene.source, changes: { ...scene.changes }, scene, shot: false });
    scene.by = new Map(scene.parameters.map((each) => [each.key, each]));
    if (other || !state.stage) {
      const before = state.stage;
      Object.assign(state, { stage: match ? before : null, run: null, compared: [] });
      if (!state.stage) opened(scene.source, `Loading ${scene.title} ...`);
    }
    $("ending").hidden = true;
    $("arrows").checked = !contest();
    document.querySelector("main").classList.toggle("contest", Boolean(contest()));
    if (player) player.fan = null;
    compare();
    document.title = `${scene.title}: sports sandbox`;
    $("about").textContent = [scene.about, scene.held && `${scene.held}: only in the window`].filter(Boolean).join(" · ");
    $("playback").hidden = $("shot-more").hidden = true;
    settings.build(scene.parameters);
    for (const [i, key] of (scene.place ?? []).entries()) settings.rows.get(key).row.querySelector("label").textContent = ["ball along", "ball across"][i];
    predicting();
    for (const each of Object.values(ask)) each.forget();
    changed(true);
    askStage();
  },
  async stage({ n, stage }) {
    if (!ask.stage.answered(n)) return;
    state.stage = await staged(stage);
    document.querySelector(".picture").classList.toggle("dark", stage.dark);
    if (state.run) show(state.run, state.composedFor === JSON.stringify(state.changes));
  },
  path({ n, run }) {
    if (!ask.path.answered(n) || state.shot) return;
    state.run = run;
    tell("");
    show(run);
  },
  shot({ n, run }) {
    if (mine() && !ask.shoot.answered(n)) return;
    tell("");
    Object.assign(state, { run, shot: true });
    show(run);
    played(run);
  },
  waits({ source, title }) {
    Object.assign(state, { source, scene: null, stage: null, run: null });
    settings.build([]);
    $("about").textContent = $("aimed").textContent = "";
    opened(source, `Waiting for a second player: open ${location.origin}${location.pathname} there, and choose ${title}, too.`);
    $("verdict").textContent = title;
  },
  left({ text }) {
    told("refused", text);
    later("refused", READ, () => told("refused", ""));
    leave();
  },
  fan({ n, said, by, lines, bars }) {
    if (!ask.fan.answered(n) || !player) return;
    player.fan = lines ? { lines } : null;
    $("fan-said").hidden = false;
    $("fan-score").textContent = said;
    $("fan-by").textContent = by || "";
    $("bars").hidden = !bars;
    $("bars-title").textContent = bars?.title ?? "";
    if (bars) drawBars($("bars"), bars.good, bars.rest, bars.ends);
    player.draw();
  },
  error({ text, n }) {
    if (!state.name && !state.plain) {
      state.plain = true; // the link cannot be read there
      wire.send(hello());
    }
    if (n === null) {
      told("refused", text);
      later("refused", READ, () => told("refused", ""));
    } else tell(text);
    if (state.scene && (!state.stage || !state.run)) waiting(text);
    if (n !== null && ask.stage.awaited === n) later("stage", ANEW, askStage);
    for (const each of Object.values(ask)) if (n !== null && each.awaited === n) each.answered(n);
  },
};

/** Show a run on the stage, once both are there; `composed` if the stage was made for it. */
function show(run, composed = false) {
  const { stage, scene } = state;
  if (!stage) return;
  const ghosts = state.compared.map((each, i) => {
    const [colour, light] = stage.others[i % stage.others.length];
    return { ...each, colour, light };
  });
  const data = { ...onStage(stage, run, run.hidden ? [] : ghosts), suspense: Boolean(contest()) };
  if (run.good !== undefined) data.scored = run.good;
  if (state.shot) data.duration = Math.max(run.duration, ...ghosts.map(({ duration }) => duration));
  if (!player) window.player = player = new Aim(data, hands);
  if (state.shot && composed) player.load(data), player.resized(), player.seek(player.data.duration);
  else if (state.shot) player.watch(data);
  else player.aim(data);
  if (composed) player.reach = player.extent;
  if (fits(stage)) waiting("");
  const other = state.scene.match && !mine() && !state.shot ? state.scene.match.status : "";
  const goal = state.lead.predict ? `Predict the ${fact()?.label ?? "result"}, then shoot` : scene.about;
  if (!state.shot) $("verdict").textContent = other || (run.hidden ? goal : run.verdict);
  if (!state.shot) standing(run.task ?? state.scene.match);
  mayShoot();
  $("notes").textContent = stage.view.notes.join("   ·   ");
  card(run, ghosts);
  if (!composed && (run.place !== stage.place || !fits(stage) || !(run.hidden || player.inSight))) later("stage", STILL, askStage);
  $("keep").disabled = Boolean(run.hidden);
}

/** Where the player is in a task: the attempt, the score, what is needed; in a match both scores, and whose turn it is. */
function standing(task) {
  $("standing").hidden = !task;
  if (!task) return;
  const part = (text, marked) => Object.assign(document.createElement("span"), { textContent: text, className: marked ? "turn" : "" });
  if (task.players) {
    $("standing").replaceChildren(...task.players.map((name, i) => part(`${name}: ${task.scores[i]}`, i === (task.winner ?? task.turn))));
    return;
  }
  const stars = task.over ? `${starred(task.stars)}` : `to pass ${task.to_pass} · ★★★ ${task.for_stars[2]}`;
  $("standing").replaceChildren(part(task.over ? task.result : `attempt ${task.attempt} of ${task.attempts}`), part(task.total, true), part(stars));
}

const starred = (stars) => "★".repeat(stars) + "☆".repeat(3 - stars);

/** A shot has been seen to its end. */
function finished() {
  if (!state.shot || state.finished === state.run) return;
  state.finished = state.run;
  standing(state.run.task ?? state.run.match);
  if (contest()) $("verdict").textContent = state.run.match?.said || state.run.verdict;
  if (contest() && !(state.run.task ?? state.run.match).over) later("next", SEEN, goOn);
  ending();
}

/** The result of a task or a match, over the picture, once its last shot was seen. */
function ending() {
  const { run } = state, end = run?.task ?? run?.match;
  $("ending").hidden = !(end?.over && state.finished === run);
  if ($("ending").hidden) return;
  $("ending-title").textContent = end.players ? end.status : end.passed ? "Passed" : "Not passed yet";
  $("ending-stars").textContent = end.players ? end.scores.map((score, i) => `${end.players[i]}: ${score}`).join("   ") : starred(end.stars);
  $("ending-said").textContent = end.players ? end.said : end.result;
  $("next-task").hidden = !following();
  mayShoot();
  $("restart").focus();
}

/** The name of the next task of the same sport, if there is one. */
function following() {
  const here = state.scenes.get(state.source), names = [...state.scenes.keys()];
  const after = names.slice(names.indexOf(state.source) + 1);
  return here?.kind === "task" ? after.find((name) => state.scenes.get(name).kind === "task" && state.scenes.get(name).sport === here.sport) : undefined;
}

/** From a shot that was seen to the next one. */
function goOn() {
  clearTimeout(timers.next);
  const { next } = state;
  if (!$("ending").hidden) return;
  if (!next) return state.scene.match ? undefined : again(true);
  [state.next, state.shot] = [null, false];
  heard.scene(next);
}

function mayShoot() {
  $("shoot").disabled = Boolean(state.lead.frozen) || !state.run || !$("ending").hidden || (!state.shot && !mine());
  $("shoot").textContent = !state.shot ? "Shoot" : contest() ? "Go on" : "Aim again";
}

/** The results, with those of the shots that are compared. */
function card(run, ghosts) {
  const columns = [run, ...state.compared], labels = [...new Set(columns.flatMap(({ rows }) => rows.map(([label]) => label)))];
  const cell = (kind, text, colour) => {
    const made = Object.assign(document.createElement(kind), { textContent: text });
    if (colour) made.style.color = colour;
    return made;
  };
  const [head, body] = [$("card").tHead, $("card").tBodies[0]];
  head.replaceChildren();
  if (ghosts.length) head.insertRow().append(cell("td", ""), cell("th", "now"), ...ghosts.map(({ label, light }) => cell("th", label, light)));
  body.replaceChildren(...labels.map((label) => {
    const row = document.createElement("tr"), name = cell("th", label);
    name.scope = "row";
    row.append(name, ...columns.map(({ rows }, i) => cell("td", rows.find(([each]) => each === label)?.[1] ?? "–", i ? ghosts[i - 1]?.light : "")));
    return row;
  }));
  if (state.shot && state.predicted !== undefined && state.lead.predict) {
    const row = document.createElement("tr");
    row.append(cell("th", "your prediction"), cell("td", `${typed(state.predicted)} ${fact()?.unit ?? ""}`));
    body.prepend(row);
  }
}

/** What a shot adds: events, energy. */
function played(run) {
  $("aimed").textContent = "";
  $("playback").hidden = Boolean(contest());
  $("shot-more").hidden = Boolean(contest());
  mayShoot();
  $("events").replaceChildren(...run.event_rows.map(([t, ...words]) => {
    const item = document.createElement("li"), button = Object.assign(document.createElement("button"), { type: "button" });
    button.append(Object.assign(document.createElement("b"), { textContent: t }), ` ${words.filter(Boolean).join(" ")}`);
    item.append(button);
    return item;
  }));
  $("energy-figure").hidden = !run.energy;
  if (run.energy && $("shot-more").open) drawEnergy($("energy"), $("energy-legend"), run.energy);
  player.now();
}

// ------------------------------------------------------------------------------------------------ comparing, predicting

function compare() {
  $("drop").hidden = !state.compared.length;
}

/** Keep this shot, to compare the next one with it. */
function keep() {
  const { run, changes, scene } = state;
  if (!run || run.hidden) return;
  const said = changedBy(changes, scene).map(([key, text]) => `${labelOf(key).split(" ").slice(1).join(" ") || key} ${text}`);
  const main = run.balls.find(({ name }) => name === run.ball);
  const label = said.length ? said.slice(0, 2).join(", ") + (said.length > 2 ? ", ..." : "") : scene.title;
  state.compared = [{ label, radius: main.radius, shift: [0, 0], path: main.path, told: run.told, duration: run.duration, rows: run.rows }, ...state.compared].slice(0, MOST_COMPARED);
  compare();
  show(run);
}

const fact = () => state.scene.facts.find(({ key }) => key === state.lead.predict);

function predicting() {
  $("predict-label").textContent = fact()?.label ?? "";
  $("predict-unit").textContent = fact()?.unit ?? "";
  state.predicted = undefined;
}

// ------------------------------------------------------------------------------------------------ messages for people

const lines = {};

/** A line at the top for as long as something holds; none where the text is empty. */
function told(what, text) {
  lines[what] = text;
  $("told").textContent = Object.values(lines).filter(Boolean).join(" ");
  $("told").hidden = !$("told").textContent;
}

const tell = (text) => told("error", text);

// ------------------------------------------------------------------------------------------------ the page

/** The first message on a line: who it is, and what is played, or what the link asks for. */
function hello() {
  const source = state.source || state.wanted;
  const here = source ? { source, changes: state.source ? state.changes : {} } : state.plain ? {} : linked(location.hash);
  return { do: "hello", session: sessionStorage.getItem("session") || "", name: state.name || localStorage.getItem("name") || "", ...here };
}

function begin() {
  settings = new Settings($("sliders"), $("rest"), (key, each) => state.lead.frozen ? settings.show(state.changes) : set({ [key]: each }));
  wire = new Wire(hello, heard);
  ask = Object.fromEntries(["path", "stage", "fan", "shoot"].map((kind) => [kind, new Latest(wire, kind)]));
  $("shoot").addEventListener("click", () => hands.shoot());
  $("prediction").addEventListener("submit", (event) => (event.preventDefault(), hands.shoot()));
  $("again").addEventListener("click", () => again(true));
  $("restart").addEventListener("click", () => play(state.source, state.scene.title));
  $("next-task").addEventListener("click", () => play(following(), state.scenes.get(following()).title));
  $("leave").addEventListener("click", leave);
  $("sports").addEventListener("click", leave);
  $("to-tiles").addEventListener("click", () => choose());
  $("choosing").addEventListener("click", ({ target }) => {
    const { source, sport } = target.closest("button")?.dataset ?? {}, title = target.closest("button")?.querySelector("b").textContent;
    const page = sport && document.querySelector(`.sport[data-sport="${CSS.escape(sport)}"]`);
    if (source && !(page && localStorage.getItem("started"))) play(source, title);
    else if (sport) choose(sport);
  });
  $("reset").addEventListener("click", () => ((state.changes = {}), changed(true)));
  $("keep").addEventListener("click", keep);
  $("drop").addEventListener("click", () => ((state.compared = []), compare(), state.run && show(state.run)));
  for (const field of names) {
    field.addEventListener("change", () => {
      localStorage.setItem("name", field.value);
      wire.send({ do: "name", name: field.value });
    });
  }
  $("fan").addEventListener("change", () => {
    $("fan-said").hidden = true;
    if (player) [player.fan = null, player.draw()];
    askFan();
  });
  $("shot-more").addEventListener("toggle", () => state.shot && state.run.energy && $("shot-more").open && drawEnergy($("energy"), $("energy-legend"), state.run.energy));
  $("copy").addEventListener("click", async () => {
    $("link").select();
    await (navigator.clipboard?.writeText($("link").value) ?? Promise.resolve(document.execCommand("copy")));
    $("copy").textContent = "Copied";
    later("copied", 1500, () => ($("copy").textContent = "Copy"));
  });
  addEventListener("resize", () => {
    if (!state.scene) return;
    if (state.stage && !fits(state.stage)) {
      waiting("Turning the picture ...");
      later("stage", STILL, askStage);
    } else if (state.stage && state.run) waiting("");
    if (state.shot && state.run.energy && $("shot-more").open) drawEnergy($("energy"), $("energy-legend"), state.run.energy);
  });
  addEventListener("hashchange", () => {
    const { source, changes } = linked(location.hash);
    if (source) opened(source, `Loading ${source} ...`), wire.send({ do: "play", source, changes });
  });
}

begin();
if (location.hash.length > 1) opened(linked(location.hash).source, "Loading ...");
else choose();
