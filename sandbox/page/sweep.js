// The map of a sweep, and the path of the point that is chosen on it. Places are in the units of the axes, paths in m.

const EDGE = { left: 64, right: 14, top: 12, bottom: 46 }; // px around the map

/** Round numbers from low to high, about so many. */
function ticks(low, high, count) {
  const rough = (high - low) / count, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((value) => value >= rough * 0.999), found = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i++) found.push(Number((i * step).toPrecision(12)));
  return found;
}

class Explorer {
  constructor(data) {
    this.data = data;
    this.chosen = data.chosen;
    this.kept = false;
    for (const name of ["map", "path"]) new ResizeObserver(() => this.draw()).observe($(name));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
    $("map").addEventListener("pointermove", (event) => this.kept || this.follow(event));
    $("map").addEventListener("pointerdown", (event) => {
      this.kept = event.pointerType === "mouse" && !this.kept;
      this.follow(event);
    });
    $("map").addEventListener("keydown", (event) => this.key(event));
    this.draw();
  }

  /** A canvas's context, as sharp as the screen, and its size in CSS px. */
  canvas(name) {
    const canvas = $(name), context = canvas.getContext("2d"), density = Math.max(1, devicePixelRatio || 1);
    const [wide, tall] = [canvas.clientWidth, canvas.clientHeight];
    if (canvas.width !== Math.round(wide * density) || canvas.height !== Math.round(tall * density)) {
      [canvas.width, canvas.height] = [Math.round(wide * density), Math.round(tall * density)];
    }
    context.setTransform(density, 0, 0, density, 0, 0);
    context.clearRect(0, 0, wide, tall);
    context.font = '13px "Sandbox Sans", "Noto Sans", sans-serif';
    const style = getComputedStyle(document.documentElement), ink = (which) => style.getPropertyValue(`--${which}`).trim();
    return { context, wide, tall, ink };
  }

  // -------------------------------------------------------------------------------------------- the map

  /** Where a value of an axis (0 across, 1 up) is, in px. */
  place(axis, value) {
    const { low, high } = this.data.axes[axis], share = high > low ? (value - low) / (high - low) : 0.5;
    const { wide, tall } = this.size;
    return axis === 0 ? EDGE.left + share * (wide - EDGE.left - EDGE.right) : tall - EDGE.bottom - share * (tall - EDGE.top - EDGE.bottom);
  }

  at(i) {
    return [0, 1].map((axis) => this.place(axis, this.data.places[axis][i]));
  }

  map() {
    const { data } = this, { context, wide, tall, ink } = this.canvas("map");
    this.size = { wide, tall };
    const cell = data.axes.map(({ step }, axis) => Math.abs(this.place(axis, step) - this.place(axis, 0)));
    data.colours.forEach((colour, i) => {
      const [x, y] = this.at(i);
      context.fillStyle = data.palette[colour];
      if (data.kind === "cells") {
        const left = Math.floor(x - cell[0] / 2), top = Math.floor(y - cell[1] / 2);
        context.fillRect(left, top, Math.ceil(x + cell[0] / 2) - left, Math.ceil(y + cell[1] / 2) - top);
      } else {
        context.beginPath();
        context.arc(x, y, 3.5, 0, 2 * Math.PI);
        context.fill();
      }
    });
    for (const { colour, points } of data.curves) {
      context.beginPath();
      for (const i of points) context.lineTo(...this.at(i));
      context.strokeStyle = colour;
      context.lineWidth = 2;
      context.stroke();
    }
    context.fillStyle = ink("quiet");
    context.textAlign = "center";
    data.axes.forEach(({ low, high, words, label }, axis) => {
      const marks = words ? words.map((word, i) => [i, word]) : ticks(low, high, axis ? 5 : Math.max(3, wide / 110)).map((value) => [value, String(value).replace("-", "−")]);
      for (const [value, text] of label ? marks : []) {
        const at = this.place(axis, value);
        context.textAlign = axis ? "right" : "center";
        context.textBaseline = axis ? "middle" : "top";
        context.fillText(text, axis ? EDGE.left - 8 : at, axis ? at : tall - EDGE.bottom + 8);
      }
      context.save();
      context.textAlign = "center";
      context.textBaseline = axis ? "top" : "bottom";
      context.translate(axis ? 2 : (EDGE.left + wide - EDGE.right) / 2, axis ? (EDGE.top + tall - EDGE.bottom) / 2 : tall - 3);
      if (axis) context.rotate(-Math.PI / 2);
      context.fillText(label, 0, 0);
      context.restore();
    });
    if (data.own !== null) this.ring(context, data.own.map((value, axis) => this.place(axis, value)), 6, ink("ink"), ink("paper"));
    this.ring(context, this.at(this.chosen), 8, "#ffb703", "#0f1720");
  }

  ring(context, [x, y], radius, colour, rim) {
    for (const [width, ink] of [[5, rim], [2.5, colour]]) {
      context.beginPath();
      context.arc(x, y, radius, 0, 2 * Math.PI);
      context.lineWidth = width;
      context.strokeStyle = ink;
      context.stroke();
    }
  }

  // -------------------------------------------------------------------------------------------- the path

  points(i) {
    const [from, until] = [this.data.starts[i], this.data.starts[i + 1]], found = [];
    for (let k = from; k < until; k++) found.push([this.data.box[0] + this.data.x[k] / this.data.scale, this.data.box[1] + this.data.y[k] / this.data.scale]);
    return found;
  }

  path() {
    const { data } = this, { context, wide, tall, ink } = this.canvas("path"), edge = 26;
    const [left, bottom, right, top] = data.box;
    const scale = Math.min((wide - 2 * edge) / (right - left), (tall - 2 * edge) / (top - bottom));
    const x = (value) => wide / 2 + (value - (left + right) / 2) * scale, y = (value) => tall / 2 - (value - (bottom + top) / 2) * scale;
    const line = (points, width, colour, opacity) => {
      context.beginPath();
      for (const [a, b] of points) context.lineTo(x(a), y(b));
      context.globalAlpha = opacity;
      context.lineJoin = context.lineCap = "round";
      context.lineWidth = width;
      context.strokeStyle = colour;
      context.stroke();
      context.globalAlpha = 1;
    };
    const every = Math.max(1, Math.ceil(data.colours.length / 150));
    for (let i = 0; i < data.colours.length; i += every) line(this.points(i), 1, ink("quiet"), 0.13);
    for (const [ax, ay, bx, by, radius] of data.surfaces) line([[ax, ay], [bx, by]], Math.max(2, 2 * radius * scale), ink("ink"), 0.75);
    const points = this.points(this.chosen), colour = data.palette[data.colours[this.chosen]];
    if (!points.length) return;
    line(points, 5, ink("ink"), 1);
    line(points, 3, colour, 1);
    const last = points[points.length - 1];
    context.beginPath();
    context.arc(x(last[0]), y(last[1]), Math.max(4, data.radius * scale), 0, 2 * Math.PI);
    context.fillStyle = "#ffb703";
    context.fill();
    context.stroke();
    const [bar] = ticks(0, (right - left) / 3, 1).slice(-1);
    if (bar) {
      context.fillStyle = ink("quiet");
      context.fillRect(edge, tall - 12, bar * scale, 2);
      context.textBaseline = "bottom";
      context.fillText(`${bar} m`, edge, tall - 14);
    }
  }

  // -------------------------------------------------------------------------------------------- choosing

  draw() {
    this.map();
    this.path();
    const { data, chosen } = this, list = $("here");
    list.replaceChildren();
    for (const { label, texts } of data.said) {
      if (!texts[chosen]) continue;
      const item = document.createElement("div");
      item.append(Object.assign(document.createElement("dt"), { textContent: label }), Object.assign(document.createElement("dd"), { textContent: texts[chosen] }));
      list.append(item);
    }
  }

  choose(i) {
    if (i === this.chosen) return;
    this.chosen = i;
    this.draw();
  }

  nearest(px, py) {
    let found = this.chosen, least = Infinity;
    for (let i = 0; i < this.data.colours.length; i++) {
      const [x, y] = this.at(i), far = this.data.kind === "curves" ? Math.abs(x - px) + 0.05 * Math.abs(y - py) : Math.hypot(x - px, y - py);
      if (far < least) [found, least] = [i, far];
    }
    return found;
  }

  follow(event) {
    const box = $("map").getBoundingClientRect();
    this.choose(this.nearest(event.clientX - box.left, event.clientY - box.top));
  }

  /** The next point in the direction of an arrow key. */
  key(event) {
    const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (!way) return;
    event.preventDefault();
    const [px, py] = this.at(this.chosen);
    let found = this.chosen, least = Infinity;
    for (let i = 0; i < this.data.colours.length; i++) {
      const [x, y] = this.at(i), along = (x - px) * way[0] + (y - py) * way[1], aside = Math.abs((x - px) * way[1]) + Math.abs((y - py) * way[0]);
      const far = along + (this.data.kind === "curves" ? 0.01 : 3) * aside;
      if (along > 0.5 && far < least) [found, least] = [i, far];
    }
    this.choose(found);
  }
}

async function begin() {
  const data = await received();
  window.explorer = new Explorer(data);
}

window.ready = begin();
