// The paths of a run, as polynomials, and how its balls are turned and drawn; lengths are in m, times in s, spins in rad/s.
//
// A second implementation of what Python has (engine/paths/path.py, picture/ball.py), for a clock: any instant is asked
// for, 60 times a second. tests/page/test_replay.py compares both.

const STEP = 1 / 60; // s

// ------------------------------------------------------------------------------------------------ what Python sent

async function image(url) {
  const found = new Image();
  found.src = url;
  await found.decode();
  return found;
}

/** Pixels of an image, as bytes of red, green, blue and opacity. */
function pixels(picture) {
  const canvas = new OffscreenCanvas(picture.width, picture.height);
  const context = canvas.getContext("2d");
  context.drawImage(picture, 0, 0);
  return context.getImageData(0, 0, picture.width, picture.height).data;
}

/** An image that fades towards its edges. */
function faded(picture) {
  const { width, height } = picture, canvas = new OffscreenCanvas(width, height), context = canvas.getContext("2d");
  context.drawImage(picture, 0, 0);
  context.globalCompositeOperation = "destination-in";
  for (const end of [[width, 0], [0, height]]) {
    const fade = context.createLinearGradient(0, 0, ...end);
    for (const [at, opacity] of [[0, 0], [0.1, 1], [0.9, 1], [1, 0]]) fade.addColorStop(at, `rgb(0 0 0 / ${opacity})`);
    context.fillStyle = fade;
    context.fillRect(0, 0, width, height);
  }
  return canvas;
}

/** Decode the layers of views and the skins of looks, which come as addresses. */
async function decode({ views, looks }) {
  const layers = views.map(async (view) => {
    for (const name of ["place", "along", "over"]) if (view[name]) view[name] = await image(view[name]);
    if (view.lens) view.lens.place = await image(view.lens.place);
    if (view.near) view.near.place = faded(await image(view.near.place));
  });
  const skins = looks.filter(({ skin }) => skin).map(async (look) => (look.skin = pixels(await image(look.skin))));
  await Promise.all([...layers, ...skins]);
}

// ------------------------------------------------------------------------------------------------ paths

const BINOMIALS = [[1]]; // by degree
for (let n = 1; n <= 12; n++) BINOMIALS.push([...BINOMIALS[n - 1], 0].map((value, k) => value + (BINOMIALS[n - 1][k - 1] ?? 0)));

/** A polynomial in Bernstein form at u from 0 to 1. */
function evaluate(curve, u) {
  const n = curve.length - 1, back = u > 0.5, r = back ? (1 - u) / u : u / (1 - u);
  let value = 0;
  for (let k = n; k >= 0; k--) value = value * r + BINOMIALS[n][k] * curve[back ? n - k : k];
  return value * (back ? u : 1 - u) ** n;
}

const derivative = (curve) =>
  curve.length > 1 ? curve.slice(1).map((value, k) => (curve.length - 1) * (value - curve[k])) : [0];

/** The integral from 0 to u. */
function integral(curve, u) {
  let sum = 0;
  const sums = [0, ...curve.map((value) => (sum += value / curve.length))];
  return evaluate(sums, u);
}

/** The path of one ball: arcs [t0, t1, x, y, spin, vx and vy if they are not derivatives, spins about x
 * and y], one after the other. Those in a heap come as steps of `heaped` from coefficient to coefficient, and with
 * speeds along x and y that are no part of the velocity. */
class Path {
  constructor({ arcs, until }, heaped) {
    const ends = [...arcs.slice(1).map(([next]) => (Array.isArray(next) ? next[0] : next)), until], last = [0, 0, 0];
    this.arcs = arcs = arcs.map(([t0, x, y, spin, within, ...across], i) => {
      const times = Array.isArray(t0) ? t0 : [t0, ends[i]];
      if (!Number.isFinite(within[0])) {
        last.fill(0);
        return [...times, x, y, spin, within, ...across];
      }
      return [...times, ...[x, y, spin].map((steps, k) => steps.map((step) => (last[k] += step) * heaped)), within, ...across];
    });
    let turned = 0;
    this.turned = arcs.map((arc) => {
      const before = turned;
      turned += (arc[1] - arc[0]) * integral(arc[4], 1);
      return before;
    });
  }

  /** The last arc that has begun at time t, and the share of it that is over. */
  find(t) {
    let low = 0, high = this.arcs.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.arcs[middle][0] <= t) low = middle;
      else high = middle - 1;
    }
    const [t0, t1] = this.arcs[low];
    return [low, t1 > t0 ? Math.min(1, Math.max(0, (t - t0) / (t1 - t0))) : 0];
  }

  /** [x, y, vx, vy, spin] at time t, after an impact at t. */
  state(t) {
    const [i, u] = this.find(t), [t0, t1, x, y, spin, within] = this.arcs[i];
    const moved = Number.isFinite(within[0]) ? within : [0, 0];
    const speeds = Array.isArray(within[0])
      ? within : [x, y].map((curve, k) => derivative(curve).map((value) => value / (t1 - t0) - moved[k]));
    return [x, y, ...speeds, spin].map((curve) => evaluate(curve, u));
  }

  /** Angle in rad that it has turned about the axis out of the picture; a body's is a polynomial of its own. */
  angle(t) {
    const [i, u] = this.find(t), [t0, t1, , , spin, , across] = this.arcs[i];
    if (across && across.length === 1) return evaluate(across[0], u);
    return this.turned[i] + (t1 - t0) * integral(spin, u);
  }

  /** Spins about x, y and out of the picture of a ball on a plane. */
  spins(t) {
    const [i, u] = this.find(t), [, , , , spin, , across] = this.arcs[i];
    return [...(across || [[0], [0]]), spin].map((curve) => evaluate(curve, u));
  }
}

// ------------------------------------------------------------------------------------------------ how balls are turned

const times = (a, b) => a.map((row) => b[0].map((_, j) => row.reduce((sum, value, k) => sum + value * b[k][j], 0)));

/** The matrix that turns by the length of the vector, in rad, about its direction. */
function turnedBy(vector) {
  const angle = Math.hypot(...vector);
  const [x, y, z] = angle ? vector.map((part) => part / angle) : [0, 0, 1];
  const c = Math.cos(angle), s = Math.sin(angle), d = 1 - c;
  return [
    [c + d * x * x, d * x * y - s * z, d * x * z + s * y],
    [d * x * y + s * z, c + d * y * y, d * y * z - s * x],
    [d * x * z - s * y, d * y * z + s * x, c + d * z * z],
  ];
}

/** How a ball on a plane is turned: followed in short steps where its axis turns. */
class Turning {
  constructor(path, start) {
    this.path = path;
    this.steps = [];
    this.known = 0; // so many arcs have been followed: not more than were asked for
    this.matrix = start; // at the end of those
  }

  follow([t0, t1]) {
    const { path } = this, a = path.spins(t0 + (t1 - t0) / 3), b = path.spins(t1 - (t1 - t0) / 3);
    const across = Math.hypot(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
    const pieces = across <= 1e-9 * Math.hypot(...a) * Math.hypot(...b) ? 1 : Math.ceil((t1 - t0) / STEP);
    for (let i = 0; i < pieces; i++) {
      const from = t0 + ((t1 - t0) * i) / pieces;
      this.steps.push([from, this.matrix]);
      this.matrix = this.after(this.matrix, from, t0 + ((t1 - t0) * (i + 1)) / pieces);
    }
  }

  after(matrix, from, until) {
    if (until <= from) return matrix;
    return times(turnedBy(this.path.spins((from + until) / 2).map((rate) => rate * (until - from))), matrix);
  }

  at(t) {
    const { arcs } = this.path;
    while (this.known < arcs.length && (!this.known || arcs[this.known][0] <= t)) this.follow(arcs[this.known++]);
    let low = 0, high = this.steps.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.steps[middle][0] <= t) low = middle;
      else high = middle - 1;
    }
    return this.after(this.steps[low][1], this.steps[low][0], t);
  }
}

// ------------------------------------------------------------------------------------------------ balls

/** Draws a ball by looking up its skin, lit from over the left shoulder; the last sprite of each size is kept. */
class Sprite {
  constructor(look, light) {
    this.look = look;
    this.light = light;
    this.kept = new Map(); // by size in px
  }

  draw(context, x, y, radius, turn) {
    const { a, b } = context.getTransform(), scale = Math.hypot(a, b), side = 2 * Math.ceil(radius * scale + 1), key = turn.flat().map((v) => v.toFixed(3)).join();
    if (this.kept.get(side)?.key !== key) this.kept.set(side, { key, canvas: this.painted(side, radius * scale, turn) });
    context.drawImage(this.kept.get(side).canvas, x - side / scale / 2, y - side / scale / 2, side / scale, side / scale);
  }

  painted(side, radius, turn) {
    const finer = radius < 40 ? 2 : 1, wide = side * finer, canvas = new OffscreenCanvas(wide, wide);
    const context = canvas.getContext("2d"), drawn = context.createImageData(wide, wide), out = drawn.data;
    const { skin, face, gloss } = this.look, { towards, dark, edge } = this.light;
    const halfway = [towards[0], towards[1], towards[2] + 1], far = Math.hypot(...halfway);
    for (let row = 0; row < wide; row++) {
      for (let column = 0; column < wide; column++) {
        let x = (column + 0.5 - wide / 2) / finer / radius, y = (wide / 2 - row - 0.5) / finer / radius;
        const away = Math.hypot(x, y), cover = Math.min(1, Math.max(0, (1 - away) * radius * finer + 0.5));
        if (!cover) continue;
        if (away > 1) [x, y] = [x / away, y / away];
        const z = Math.sqrt(Math.max(0, 1 - x * x - y * y));
        const own = [0, 1, 2].map((j) => x * turn[0][j] + y * turn[1][j] + z * turn[2][j]);
        const place = (value) => Math.min(face - 1, Math.floor(((value + 1) / 2) * face));
        const from = 4 * (place(own[1]) * 2 * face + place(own[0]) + (own[2] < 0 ? face : 0));
        const lit = Math.max(0, x * towards[0] + y * towards[1] + z * towards[2]);
        const bright = (dark + (1.16 - dark) * lit) * (edge + (1 - edge) * Math.sqrt(z));
        const shine = gloss * 255 * Math.max(0, (x * halfway[0] + y * halfway[1] + z * halfway[2]) / far) ** 60;
        const to = 4 * (row * wide + column);
        for (let i = 0; i < 3; i++) out[to + i] = skin[from + i] * bright + shine;
        out[to + 3] = 255 * cover;
      }
    }
    context.putImageData(drawn, 0, 0);
    return canvas;
  }
}
