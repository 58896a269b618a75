// Plays a run on a place. Its paths are the polynomials that the run was computed with, so any instant is exact; lengths
// are in m, times in s, spins in rad/s, and on the picture in px of the layer that is shown.
//
// The place, the look of all that moves, arrows, colours and sizes come from Python. A second implementation, for a clock
// and a pointer, is what depends on the instant: where things are drawn, shadows, arrows, the nearest path, and the
// numbers of the ball (picture/moving.py, picture/painter.py, sport/amounts.py). tests/page/test_replay.py compares them.

const SLOWEST = -4, FASTEST = 3; // powers of two
const VERDICT = 1000; // ms for which the verdict is large and coloured once it is in
const CROSSES = [1.2, 2.2]; // times larger: between them the layer of what decides comes, and letters go
const NEAR = 28; // px around the pointer in which a path is found

const reduced = matchMedia("(prefers-reduced-motion: reduce)"); // then the camera stands still, and time passes evenly

// ------------------------------------------------------------------------------------------------ numbers for people

let ladders = {};

/** A number of a unit, on the ladder that Python uses. */
function amount(value, unit) {
  const steps = ladders[unit], step = steps.find(([least]) => Math.abs(value) >= least) || steps[steps.length - 1];
  const [, factor, name, digits] = step, text = (value * factor).toFixed(digits);
  const number = Number(text) === 0 ? text.replace("-", "") : text.replace("-", "−");
  return name === "deg" ? `${number}°` : `${number} ${name}`;
}

// ------------------------------------------------------------------------------------------------ the page

class Player {
  constructor(data, canvas = $("picture")) {
    this.canvas = canvas;
    this.context = this.canvas.getContext("2d");
    this.power = 0; // of two: the speed
    this.hint = document.createElement("div");
    this.hint.id = "hint";
    this.hint.hidden = true;
    this.canvas.after(this.hint);
    this.controls();
    this.load(data);
    this.keys();
    this.pointer();
    new ResizeObserver(() => this.resized()).observe(this.canvas);
    this.resized();
  }

  /** Take a run on its place; it is whole, as on a poster, until it is played. */
  load(data) {
    this.data = data;
    ladders = data.ladders;
    for (const ball of data.balls) {
      const look = data.looks[ball.look] || data.looks[0];
      ({ shapes: ball.shapes, rimmed: ball.rimmed } = look);
      ball.sprite = this.sprites.get(look) || new Sprite(look, data.light);
      if (data.balls.length === 1) this.sprites.set(look, ball.sprite); // the next run draws the same one
    }
    for (const ball of [...data.balls, ...data.ghosts]) {
      if (!(ball.path instanceof Path)) ball.path = new Path(ball.path, data.heaped);
      ball.tied = null; // where its string is tied
      if (ball.rolls) ball.turning = new Turning(ball.path, ball.lying);
    }
    this.main = data.balls.find((ball) => ball.name === data.ball);
    for (const [ball, ...tied] of data.strings) data.balls[ball].tied = tied;
    for (const ghost of data.ghosts) ghost.tied = this.main.tied;
    this.whole = true;
    this.playing = false;
    this.t = data.told;
    this.after = 0; // s since the end
    this.verdict("");
    this.pointed = null;
    this.hint.hidden = true;
    this.timeline();
  }

  /** The slider of time, with a mark at each event. */
  timeline() {
    const { data } = this;
    $("time").max = data.duration;
    $("marks").replaceChildren(...[...new Set(data.events)].map((t) => {
      const mark = document.createElement("i");
      mark.style.left = `${(100 * t) / data.duration}%`;
      return mark;
    }));
  }

  sprites = new WeakMap();

  // -------------------------------------------------------------------------------------------- the picture

  resized() {
    const wide = this.canvas.clientWidth, views = this.data.views;
    this.view = views[wide < 700 ? views.length - 1 : 0];
    const [width, height] = this.across, density = Math.max(1, window.devicePixelRatio || 1);
    this.canvas.style.aspectRatio = `${width} / ${height}`;
    this.shown = wide / width; // CSS px for one of the view
    this.canvas.width = Math.round(wide * density);
    this.canvas.height = Math.round((wide * density * height) / width);
    for (const ball of [...this.data.balls, ...this.data.ghosts]) {
      ball.line = this.line(ball);
      ball.near = this.view.lens && this.through(this.view.lens, () => this.line(ball));
    }
    this.heading(wide);
    this.draw();
  }

  /** Size of the picture in px of the layer, as it is shown: a layer may be turned by a quarter to the left. */
  get across() {
    const [width, height] = this.view.size;
    return this.view.turned ? [height, width] : [width, height];
  }

  /** Draw in px of the layer from now on, of which each is so many px of the canvas. */
  onLayer(density) {
    const { turned, size } = this.view;
    this.context.setTransform(...(turned ? [0, -density, density, 0, 0, density * size[0]] : [density, 0, 0, density, 0, 0]));
  }

  /** The headline is as large as fits on one line. */
  heading(wide) {
    const title = document.querySelector("h1"), room = this.view.room * this.shown;
    title.parentElement.style.maxWidth = `${room}px`;
    title.className = "";
    if (wide >= 700 && title.offsetHeight > 1.5 * parseFloat(getComputedStyle(title).lineHeight)) title.className = "medium";
  }

  ground(x) {
    const { from, step, heights } = this.data.ground, place = Math.min(Math.max((x - from) / step, 0), heights.length - 1);
    const i = Math.min(Math.floor(place), heights.length - 2);
    return heights[i] + (place - i) * (heights[i + 1] - heights[i]);
  }

  pixel(x, y) {
    const { at, anchor, scale, stretch } = this.view;
    return [anchor[0] + (x - at[0]) * scale, anchor[1] - (y - at[1]) * scale * stretch];
  }

  /** Where a ball of a radius in px is drawn: one on a string raised so that this does not stretch, for swings are
   *  simulated as small ones, along a level; one that is drawn too large lies on the ground and not in it. */
  spot(ball, x, y, radius = 0) {
    if (ball.tied) y = ball.tied[1] - Math.sqrt(Math.max(0, (ball.tied[1] - y) ** 2 - (x - ball.tied[0]) ** 2));
    const [px, py] = this.pixel(x, y);
    if (!this.data.ground || this.view.lift === null) return [px, py];
    const ground = this.ground(x);
    return [px, y > ground ? Math.min(py - this.view.lift, this.pixel(x, ground)[1] - radius) : py];
  }

  /** Points [x, y, t] of a path until its end is told, close enough together to look smooth. */
  line(ball) {
    const [dx, dy] = ball.shift || [0, 0], points = [], { scale, stretch } = this.view, { told = this.data.told } = ball;
    for (const [t0, t1, x, y] of ball.path.arcs) {
      if (t0 > told) break;
      let long = 0;
      for (let k = 1; k < x.length; k++) long += Math.hypot(x[k] - x[k - 1], (y[k] - y[k - 1]) * stretch) * scale;
      const pieces = Math.max(1, Math.min(200, Math.ceil(long / 4)));
      for (let i = 0; i <= pieces; i++) {
        const t = Math.min(told, t0 + ((t1 - t0) * i) / pieces), u = t1 > t0 ? (t - t0) / (t1 - t0) : 0;
        points.push([...this.spot(ball, evaluate(x, u) + dx, evaluate(y, u) + dy), t]);
      }
    }
    return points;
  }

  trace(points, from, until, width, colour, opacity, rim) {
    const { context } = this;
    context.beginPath();
    for (const [x, y, t] of points) if (t >= from && t <= until) context.lineTo(x, y);
    context.lineJoin = context.lineCap = "round";
    context.globalAlpha = opacity;
    for (const [wide, ink] of rim ? [[width + rim, this.data.rim], [width, colour]] : [[width, colour]]) {
      context.lineWidth = wide;
      context.strokeStyle = ink;
      context.stroke();
    }
    context.globalAlpha = 1;
  }

  /** The keyframe of the story's camera and pace at the time that is shown; null where it stands still. */
  keyframe() {
    const keys = this.data.story?.keys, t = this.t + this.after;
    if (!keys?.length || this.whole || reduced.matches) return null;
    let low = 0, high = keys.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (keys[middle][0] <= t) low = middle;
      else high = middle;
    }
    const share = Math.min(1, Math.max(0, (t - keys[low][0]) / (keys[high][0] - keys[low][0] || 1)));
    return keys[low].map((value, k) => value + share * (keys[high][k] - value));
  }

  /** How the layers are shown now: so many times larger, and moved by px. */
  seen() {
    const key = this.keyframe();
    if (!key || key[3] === 1) return { larger: 1, across: 0, down: 0 };
    const [, x, y, larger] = key, [, x0, y0] = this.data.story.keys[0], from = this.pixel(x, y), to = this.pixel(x0, y0);
    return { larger, across: to[0] - from[0] * larger, down: to[1] - from[1] * larger };
  }

  /** The place in CSS px of the canvas of a place in px of the layer, as it is shown now. */
  onScreen([x, y]) {
    const { larger, across, down } = this.seen(), [u, v] = [x * larger + across, y * larger + down];
    return (this.view.turned ? [v, this.view.size[0] - u] : [u, v]).map((value) => value * this.shown);
  }

  draw() {
    const { context, data, whole, view: layer } = this, { larger, across, down } = this.seen();
    const t = this.t, faint = whole || t >= data.told ? 1 : 0.3;
    const density = this.canvas.width / this.across[0], crossed = Math.min(1, Math.max(0, (larger - CROSSES[0]) / (CROSSES[1] - CROSSES[0])));
    this.onLayer(density);
    context.transform(larger, 0, 0, larger, across, down);
    if (larger !== 1) this.view = { ...layer, unit: layer.unit / larger, least: layer.least / larger, lift: layer.lift && layer.lift / larger };
    const { view } = this, { unit } = view;
    context.drawImage(view.place, 0, 0);
    if (view.near && crossed) {
      context.globalAlpha = crossed;
      context.drawImage(view.near.place, ...view.near.corner, ...view.near.size);
      context.globalAlpha = 1;
    }
    this.driven(whole ? data.shown : t);
    for (const ball of data.balls.filter((ball) => ball.tied)) {
      const [x, y] = ball.path.state(t);
      context.beginPath();
      context.moveTo(...this.pixel(...ball.tied));
      context.lineTo(...this.spot(ball, x, y));
      context.lineWidth = 1.5 * unit;
      context.strokeStyle = data.string;
      context.stroke();
    }
    this.beneath();
    for (const ghost of data.ghosts) this.trace(ghost.line, 0, Infinity, 4.5 * unit, ghost.colour, data.earlier);
    const balls = [...data.balls.filter((ball) => ball !== this.main), this.main];
    for (const ball of balls) {
      const width = ball.thickness * Math.max(2.5, 4.5 * unit), rim = 2 * Math.max(0.75, unit);
      const here = [...this.spot(ball, ...ball.path.state(t).slice(0, 2)), t];
      if (faint < 1 && !data.suspense) this.trace(ball.line, 0, Infinity, width, ball.colour, faint);
      this.trace(faint < 1 ? [...ball.line.filter((point) => point[2] < t), here] : ball.line, 0, Infinity, width, ball.colour, 1, rim);
    }
    context.globalAlpha = 1 - crossed;
    if (faint === 1 && view.along && crossed < 1) context.drawImage(view.along, 0, 0);
    context.globalAlpha = 1;
    for (const ghost of data.ghosts) this.ghost(ghost, whole ? ghost.told : t);
    if (!whole && $("arrows")?.checked) this.vectors(t);
    for (const ball of balls) this.ball(ball, t);
    context.globalAlpha = 1 - crossed;
    if (crossed < 1) context.drawImage(view.over, 0, 0);
    context.globalAlpha = 1;
    if (view.lens && (faint < 1 || !view.along)) this.lens(() => this.nearBy(t, faint < 1 ? t : Infinity));
    if (this.pointed) this.point();
    this.view = layer;
    context.setTransform(density, 0, 0, density, 0, 0);
    this.above();
    this.now();
  }

  /** Do something with the camera of a lens. */
  through(lens, draw) {
    const { view } = this;
    this.view = { ...lens, lift: null };
    const found = draw();
    this.view = view;
    return found;
  }

  /** Draw on the part that is seen from near by, as its camera sees it. */
  lens(draw) {
    const { context, data, view: { lens, unit } } = this, { corner: [left, top], size: [wide, high] } = lens;
    context.save();
    context.beginPath();
    context.rect(left, top, wide, high);
    context.clip();
    context.drawImage(lens.place, left, top, wide, high);
    this.through(lens, draw);
    context.restore();
    Object.assign(context, { lineWidth: Math.max(1, unit), strokeStyle: data.quiet });
    context.strokeRect(left - 0.5, top - 0.5, wide + 1, high + 1);
  }

  /** What is there at time t, with the paths until a time. */
  nearBy(t, until) {
    const { data, view: { unit, scale } } = this;
    for (const ball of data.balls) {
      const [, , x, y] = ball.path.arcs[0], width = (ball === this.main ? 3.4 : 2.2) * unit;
      const been = ball.near.filter(([, , at]) => at <= until), here = ball.path.state(Math.min(until, data.told));
      if (ball !== this.main && been.length > 1) this.circle(...this.pixel(x[0], y[0]), ball.radius * scale, ball.colour, 1.5 * unit);
      this.trace([...been, [...this.spot(ball, ...here), 0]], 0, Infinity, width, ball.colour, 0.8);
    }
    for (const ghost of data.ghosts) this.trace(ghost.near, 0, Infinity, 2.4 * unit, ghost.colour, 0.8);
    for (const ball of data.balls) this.ball(ball, t);
  }

  circle(x, y, radius, colour, width) {
    const { context } = this;
    context.beginPath();
    context.arc(x, y, radius, 0, 2 * Math.PI);
    Object.assign(context, { lineWidth: width, strokeStyle: colour });
    context.stroke();
  }

  /** What other pages draw on the place under all paths, and over everything. */
  beneath() {}

  above() {}

  /** The surfaces that move, where they are at time t. */
  driven(t) {
    const { context, view, data } = this, { step, surfaces } = data.driven, { colour, thinnest } = data.driver;
    for (const { radius, ends } of surfaces) {
      const place = Math.min(t / (step || 1), ends.length - 1), i = Math.min(Math.floor(place), ends.length - 2);
      const [ax, ay, bx, by] = ends[i].map((value, k) => value + (place - i) * (ends[i + 1][k] - value));
      context.beginPath();
      context.moveTo(...this.pixel(ax, ay));
      context.lineTo(...this.pixel(bx, by));
      Object.assign(context, { lineCap: "round", lineWidth: 2 * Math.max(radius * view.scale, thinnest * view.unit), strokeStyle: colour });
      context.stroke();
    }
  }

  ball(ball, t) {
    if (ball !== this.main && ball.caught !== null && t >= ball.caught) return; // where the main one ended stays to be seen
    const { context, view, data } = this, [x, y] = ball.path.state(t);
    const radius = Math.max(ball.radius * view.scale, view.least), [px, py] = this.spot(ball, x, y, radius);
    if (ball.fall && t >= ball.fall.start) this.fallen(ball, px, py, radius, t);
    else if (ball.shapes) this.flat(ball, px, py, radius, this.angle(ball, t));
    else this.round(ball, t, x, y, px, py, radius);
    if (data.balls.length === 1 && radius > data.unsaid * ball.radius * view.scale) {
      const reach = ball.shapes && Math.max(...ball.shapes.flatMap(([corners]) => corners.map((corner) => Math.hypot(...corner))));
      context.beginPath();
      context.arc(px, py, ball.shapes ? reach * radius + 2 * view.unit : radius + 4.5 * view.unit, 0, 2 * Math.PI);
      context.lineWidth = Math.max(1.2, 1.7 * view.unit);
      context.strokeStyle = data.accent;
      context.stroke();
    }
  }

  round(ball, t, x, y, px, py, radius) {
    const { context, view, data } = this;
    this.shadow(ball, x, y, px, py, radius);
    context.globalAlpha = data.light.rim;
    this.disc(px, py, radius + this.rim, data.rim);
    context.globalAlpha = 1;
    const turn = ball.turning ? ball.turning.at(t) : times(turnedBy([0, 0, this.angle(ball, t)]), ball.lying);
    ball.sprite.draw(context, px, py, radius, turn);
  }

  /** How far a ball or body is turned about the axis out of the picture, in rad. */
  angle(ball, t) {
    if (!ball.turned) return ball.path.angle(t);
    const { times, angles } = ball.turned, place = Math.min(t / (times[1] || 1), times.length - 1), i = Math.min(Math.floor(place), times.length - 2);
    return angles[i] + (place - i) * (angles[i + 1] - angles[i]);
  }

  /** The width of the thin dark rim around balls and bodies, in px. */
  get rim() {
    return Math.max(0.7, 0.8 * this.view.unit);
  }

  /** What begins standing, once it falls: from the side, and the longer the more it lies. */
  fallen(ball, px, py, radius, t) {
    const { start, towards, takes, shapes } = ball.fall, lies = t >= this.data.told ? 1 : Math.min(1, 0.2 + (t - start) / takes);
    const angle = towards + this.angle(ball, Math.min(t, ball.caught ?? t)) - this.angle(ball, start);
    this.flat({ shapes, rimmed: true }, px, py, radius, angle, lies);
  }

  /** What is not round: shapes with corners in radii around (px, py); `along` shortens them along their own x. */
  flat({ shapes, rimmed }, px, py, radius, angle, along = 1) {
    const { context, data } = this, c = radius * Math.cos(angle), s = radius * Math.sin(angle);
    for (const [i, [corners, colour]] of shapes.entries()) {
      context.beginPath();
      for (const [a, b] of corners) context.lineTo(px + c * along * a - s * b, py - s * along * a - c * b);
      if (rimmed && !i) {
        context.closePath();
        Object.assign(context, { globalAlpha: data.light.rim, lineWidth: 2 * this.rim, lineJoin: "round", strokeStyle: data.rim });
        context.stroke();
        context.globalAlpha = 1;
      }
      context.fillStyle = colour;
      context.fill();
    }
  }

  shadow(ball, x, y, px, py, radius) {
    const { context, view, data } = this;
    let at = [px + 0.4 * radius, py + 0.5 * radius], size = [1.05 * radius, 0.95 * radius], dark = 0.55;
    if (data.ground) {
      const ground = this.ground(x), height = y - ball.radius - ground;
      if (height < -0.5 * ball.radius) return;
      const near = 1 / (1 + (Math.max(0, height) * view.scale * view.stretch) / (80 * view.unit));
      at = [px, this.pixel(x, ground)[1] + view.unit];
      size = [radius * (2.2 - near), 0.35 * radius];
      dark = 0.15 + 0.45 * near;
    } else if (!data.shadows) return;
    context.save();
    context.translate(...at);
    context.scale(...size);
    const fading = context.createRadialGradient(0, 0, 0.4, 0, 0, 1.4);
    fading.addColorStop(0, data.shadow);
    fading.addColorStop(1, `${data.shadow}00`);
    context.fillStyle = fading;
    context.globalAlpha = dark;
    context.fillRect(-1.5, -1.5, 3, 3);
    context.restore();
  }

  disc(x, y, radius, colour) {
    this.context.beginPath();
    this.context.arc(x, y, radius, 0, 2 * Math.PI);
    this.context.fillStyle = colour;
    this.context.fill();
  }

  /** Another run's ball, with its name beside it. */
  ghost(ghost, t) {
    const { view } = this, { arcs } = ghost.path, until = Math.min(t, arcs[arcs.length - 1][1]);
    const [x, y] = ghost.path.state(until), radius = Math.max(3, 6 * view.unit);
    const [px, py] = this.spot(ghost, x + ghost.shift[0], y + ghost.shift[1], radius);
    this.disc(px, py, radius, ghost.light);
    this.label(ghost.label, px, py - radius - 5 * view.unit, ghost.light);
  }

  /** A text, after a dot of its own colour if it has one, on a dark label above a place, within the picture and clear of
   *  the labels that are `taken`. */
  label(text, x, y, colour, taken = [], dot = "") {
    const { context, view } = this, [width, height] = this.across, within = (value, high) => Math.max(4, Math.min(value, high - 4));
    if (view.turned) { // letters stand upright
      [x, y] = [y, view.size[0] - x];
      context.save();
      context.translate(view.size[0], 0);
      context.rotate(Math.PI / 2);
    }
    context.font = `700 ${Math.max(11, 14.5 * view.unit)}px "Sandbox Sans", "Noto Sans", sans-serif`;
    context.textBaseline = "middle";
    const start = (dot ? 18 : 6) * view.unit, wide = context.measureText(text).width + start + 6 * view.unit, tall = 22 * view.unit;
    const left = within(x - wide / 2, width - wide);
    let top = within(y - tall, height - tall);
    const covered = () => taken.some((each) => Math.abs(top - each.top) < tall && left < each.left + each.wide && each.left < left + wide);
    while (top > 4 && covered()) top -= 2 * view.unit;
    taken.push({ left, top, wide });
    context.fillStyle = this.data.card;
    context.beginPath();
    context.roundRect(left, top, wide, tall, tall / 2);
    context.fill();
    context.fillStyle = colour;
    context.fillText(text, left + start, top + tall / 2);
    if (dot) this.disc(left + 10 * view.unit, top + tall / 2, 4 * view.unit, dot);
    if (view.turned) context.restore();
  }

  // -------------------------------------------------------------------------------------------- arrows

  /** Name and colour of each force, and its components in N at time t. */
  forces(t) {
    const { times: at, causes } = this.data.forces;
    let i = at.findIndex((other) => other > t);
    i = i < 0 ? at.length - 2 : Math.max(0, i - 1);
    const u = at[i + 1] > at[i] ? Math.min(1, (t - at[i]) / (at[i + 1] - at[i])) : 1;
    return causes.map(({ name, colour, x, y }) => {
      const both = [x, y].map((values) => (values[i] === null || values[i + 1] === null ? null : values[i] + u * (values[i + 1] - values[i])));
      return { name, colour, force: both.includes(null) ? null : both };
    });
  }

  vectors(t) {
    const { view, main, data } = this, [x, y, vx, vy] = main.path.state(t);
    if (main.caught !== null && t >= main.caught) return;
    const radius = Math.max(main.radius * view.scale, view.least), at = this.spot(main, x, y, radius);
    const arrow = (vector, longest, length, width, colour) => {
      const size = Math.hypot(...vector), shown = longest > 0 ? Math.min(1.5, size / longest) * length * view.unit : 0;
      if (shown < data.arrow.shortest * view.unit) return;
      const along = vector[0] / size, down = -vector[1] / size;
      const tail = [at[0] + along * radius, at[1] + down * radius];
      this.arrow(tail, along, down, shown, Math.min(width, shown / view.unit / 4.2) * view.unit, colour);
    };
    arrow([vx, vy], data.longest.fastest, data.arrow.velocity, 3.4, data.arrow.colour);
    for (const { force, colour } of this.forces(t)) if (force) arrow(force, data.longest.strongest, data.arrow.force, 4.2, colour);
  }

  arrow([x, y], along, down, length, width, colour) {
    const { context } = this, head = Math.min(3.5 * width, length), half = 0.62 * head, neck = length - head;
    const corners = [[0, -width / 2], [neck, -width / 2], [neck, -half], [length, 0], [neck, half], [neck, width / 2], [0, width / 2]];
    context.beginPath();
    for (const [a, b] of corners) context.lineTo(x + a * along - b * down, y + a * down + b * along);
    context.closePath();
    context.lineJoin = "round";
    context.lineWidth = 2 * Math.max(0.7, this.view.unit);
    context.strokeStyle = this.data.shadow;
    context.stroke();
    context.fillStyle = colour;
    context.fill();
  }

  // -------------------------------------------------------------------------------------------- what is said

  /** Label and text of what a ball does at time t, as on the card of a frame. */
  entries(ball, t) {
    const [x, y, vx, vy, spin] = ball.path.state(t), rpm = (spin * 30) / Math.PI, speed = Math.hypot(vx, vy);
    const place = this.data.ground
      ? [["height", amount(Math.max(0, y - ball.radius - this.ground(x)), "m")]]
      : [["x", amount(x, "m")], ["y", amount(y, "m")]];
    return [
      ["time", amount(t, "s")],
      ["speed", amount(speed, "m/s")],
      ...place,
      ["direction", speed > 0.01 ? amount((Math.atan2(vy, vx) * 180) / Math.PI, "deg") : "–"],
      ["spin", Math.abs(rpm) < 0.5 ? "none" : `${amount(Math.abs(rpm), "rpm")} ${this.data.spins[rpm > 0 ? 1 : 0]}`],
    ];
  }

  now() {
    const { data, main, t } = this, entries = this.entries(main, t).map((entry) => [...entry, ""]);
    if (!(main.caught !== null && t >= main.caught)) {
      for (const { name, force, colour } of this.forces(t)) if (force) entries.push([name, amount(Math.hypot(...force), "N"), colour]);
    }
    const list = $("now");
    while (list.children.length > entries.length) list.lastChild.remove();
    entries.forEach(([label, text, colour], i) => {
      const item = list.children[i] || list.appendChild(document.createElement("div"));
      if (!item.children.length) item.append(document.createElement("dt"), document.createElement("dd"));
      const [term, value] = item.children;
      if (term.textContent !== label) {
        term.textContent = label;
        if (colour) {
          const dot = document.createElement("i");
          dot.style.background = colour;
          term.prepend(dot);
        }
      }
      value.textContent = text;
    });
    const slider = $("time");
    slider.value = t;
    slider.setAttribute("aria-valuetext", entries.slice(0, data.ground ? 3 : 2).map(([label, text]) => `${label} ${text}`).join(", "));
    $("clock").textContent = `${amount(t, "s")} of ${amount(data.duration, "s")}`;
    $("play").textContent = this.playing ? "Pause" : "Play";
    document.querySelectorAll("#events li").forEach((item, i) => item.classList.toggle("past", !this.whole && data.events[i] <= t));
  }

  // -------------------------------------------------------------------------------------------- time

  seek(t) {
    this.whole = false;
    this.t = Math.min(Math.max(t, 0), this.data.duration);
    this.after = 0;
    this.draw();
  }

  play() {
    this.playing = !this.playing;
    if (this.playing && (this.whole || this.t >= this.data.duration)) this.seek(0);
    this.last = performance.now();
    if (this.playing) requestAnimationFrame((now) => this.tick(now));
    this.now();
  }

  tick(now) {
    if (!this.playing) return;
    const passed = Math.max(0, Math.min((now - this.last) / 1000, 0.1)), { t, data: { told, scored } } = this;
    this.last = now;
    if (t >= this.data.duration) return this.rest(passed);
    const slower = this.power ? 1 : this.keyframe()?.[4] ?? 1;
    this.seek(this.t + (passed * 2 ** this.power) / slower);
    if (this.t >= this.data.duration && !this.goesOn) this.playing = false;
    if (t < told && this.t >= told && scored !== null) this.verdict(scored ? "good" : "bad");
    if (this.playing) requestAnimationFrame((next) => this.tick(next));
  }

  /** True if the camera is still on its way back after the end. */
  get goesOn() {
    return Boolean(this.data.story) && !reduced.matches && this.after < this.data.story.after;
  }

  /** After the end only the camera goes on. */
  rest(passed) {
    this.after += passed;
    this.playing = this.goesOn;
    this.draw();
    if (this.playing) requestAnimationFrame((next) => this.tick(next));
  }

  /** Mark the verdict for a moment as good or bad, larger if there is room; as usual without a word. */
  verdict(word) {
    const title = document.querySelector("h1");
    title.dataset.verdict = word;
    if (word) title.style.setProperty("--larger", Math.max(1, Math.min(1.25, (0.9 * this.canvas.clientWidth) / title.offsetWidth)));
    clearTimeout(this.called);
    if (word) this.called = setTimeout(() => this.verdict(""), VERDICT);
  }

  step(by) {
    this.playing = false;
    this.seek((this.whole ? 0 : this.t) + by * STEP);
  }

  faster(by) {
    this.power = Math.min(Math.max(this.power + by, SLOWEST), FASTEST);
    $("rate").value = this.power;
  }

  controls() {
    const slider = $("time"), rate = $("rate");
    slider.addEventListener("input", () => {
      this.playing = false;
      this.seek(Number(slider.value));
    });
    for (let power = SLOWEST; power <= FASTEST; power++) rate.add(new Option(power < 0 ? `1/${2 ** -power}` : `${2 ** power}×`, power));
    rate.value = 0;
    rate.addEventListener("change", () => (this.power = Number(rate.value)));
    $("play").addEventListener("click", () => this.play());
    $("back").addEventListener("click", () => this.step(-1));
    $("on").addEventListener("click", () => this.step(1));
    $("arrows").addEventListener("change", () => this.draw());
    $("events").addEventListener("click", (event) => {
      const item = event.target.closest("li");
      if (!item) return;
      this.playing = false;
      this.seek(this.data.events[[...$("events").children].indexOf(item)]);
    });
  }

  keys() {
    const commands = {
      " ": () => this.play(), r: () => { this.seek(0); if (!this.playing) this.play(); }, ",": () => this.step(-1), ".": () => this.step(1),
      "+": () => this.faster(1), "=": () => this.faster(1), "-": () => this.faster(-1), o: () => $("arrows").click(),
      ArrowLeft: () => this.step(-1), ArrowRight: () => this.step(1),
      Home: () => this.seek(0), End: () => this.seek(this.data.duration),
    };
    document.addEventListener("keydown", (event) => {
      const command = commands[event.key], on = event.target.closest("button, select, summary, input[type=checkbox]");
      const field = event.target.closest("input");
      if (field && field.id !== "time" && field.type !== "checkbox") return; // it is typed into
      if (!command || event.ctrlKey || event.altKey || event.metaKey || (on && (event.key === " " || on.tagName === "SELECT"))) return;
      event.preventDefault();
      command();
    });
  }

  // -------------------------------------------------------------------------------------------- pointing

  pointer() {
    const { canvas } = this;
    canvas.addEventListener("pointermove", (event) => this.follow(event));
    canvas.addEventListener("pointerdown", (event) => this.follow(event));
    canvas.addEventListener("pointerleave", (event) => this.left(event));
    canvas.addEventListener("click", () => this.go());
  }

  /** Read the path under the pointer. */
  follow(event) {
    this.pointed = this.nearest(...this.under(event));
    this.hint.hidden = !this.pointed;
    this.canvas.style.cursor = this.pointed ? "pointer" : "";
    this.draw();
  }

  /** The place under the pointer, in CSS px of the canvas. */
  inside(event) {
    const box = this.canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  /** The place under the pointer, in px of the layer. */
  under(event) {
    const { larger, across, down } = this.seen(), at = this.inside(event).map((value) => value / this.shown);
    const [x, y] = this.view.turned ? [this.view.size[0] - at[1], at[0]] : at;
    return [(x - across) / larger, (y - down) / larger];
  }

  left(event) {
    if (event.pointerType === "mouse") [this.pointed, this.hint.hidden] = [null, true];
    this.draw();
  }

  /** Go to the time that is pointed at. */
  go() {
    if (!this.pointed) return;
    this.playing = false;
    this.seek(this.pointed.t);
  }

  /** The ball and the time whose place on the picture is nearest to a point in px, if one is near. */
  nearest(px, py) {
    let least = NEAR / this.shown, found = null;
    for (const ball of [...this.data.ghosts, ...this.data.balls]) {
      for (let i = 1; i < ball.line.length; i++) {
        const [ax, ay, at] = ball.line[i - 1], [bx, by, bt] = ball.line[i], long = (bx - ax) ** 2 + (by - ay) ** 2;
        const share = long ? Math.min(1, Math.max(0, ((px - ax) * (bx - ax) + (py - ay) * (by - ay)) / long)) : 0;
        const far = Math.hypot(ax + share * (bx - ax) - px, ay + share * (by - ay) - py);
        if (far < least) [least, found] = [far, { ball, t: at + share * (bt - at) }];
      }
    }
    return found;
  }

  point() {
    const { ball, t } = this.pointed, { view, data } = this, [x, y] = ball.path.state(t), [dx, dy] = ball.shift || [0, 0];
    const [px, py] = this.spot(ball, x + dx, y + dy);
    this.disc(px, py, 6 * view.unit, data.rim);
    this.disc(px, py, 4.5 * view.unit, data.accent);
    const name = ball.label || (data.balls.length > 1 ? ball.name : "");
    this.hint.replaceChildren();
    if (name) this.hint.append(Object.assign(document.createElement("b"), { textContent: name }));
    for (const [label, text] of this.entries(ball, t)) this.hint.append(Object.assign(document.createElement("div"), { textContent: `${label} ${text}` }));
    const [left, top] = this.onScreen([px, py]), wide = this.hint.offsetWidth, tall = this.hint.offsetHeight;
    this.hint.style.left = `${Math.min(Math.max(4, left + 16), this.canvas.clientWidth - wide - 4)}px`;
    this.hint.style.top = `${top - tall - 12 > 0 ? top - tall - 12 : top + 16}px`;
  }
}
