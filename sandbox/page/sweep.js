// Which point of a sweep is chosen, by pointer or arrow keys, for that needs an answer at once. The chart, the paths and
// where each point is on the chart (as shares of its width and height) come from Python.

class Explorer {
  constructor(data) {
    this.data = data;
    this.kept = false;
    const map = $("map");
    map.addEventListener("pointermove", (event) => this.kept || this.follow(event));
    map.addEventListener("pointerdown", (event) => {
      this.kept = event.pointerType === "mouse" && !this.kept;
      this.follow(event);
    });
    map.addEventListener("keydown", (event) => this.key(event));
    this.choose(data.chosen);
  }

  /** Where a point is, in CSS px of the chart. */
  at(i) {
    const { width, height } = document.querySelector("#map svg").getBoundingClientRect();
    return [this.data.x[i] * width, this.data.y[i] * height];
  }

  /** The path of a point, in m. */
  points(i) {
    const { starts, path } = this.data, found = [];
    for (let k = starts[i]; k < starts[i + 1]; k++) found.push([path[2 * k], path[2 * k + 1]]);
    return found;
  }

  choose(i) {
    this.chosen = i;
    const points = this.points(i), line = points.length ? `M${points.join("L")}` : "", list = $("here");
    for (const name of ["rim", "flown"]) $(name).setAttribute("d", line);
    $("ball").setAttribute("d", points.length ? `M${points[points.length - 1]}h0` : "");
    Object.assign($("ring").style, { left: `${100 * this.data.x[i]}%`, top: `${100 * this.data.y[i]}%` });
    list.replaceChildren();
    for (const { label, texts } of this.data.texts) {
      if (!texts[i]) continue;
      const item = document.createElement("div");
      item.append(Object.assign(document.createElement("dt"), { textContent: label }), Object.assign(document.createElement("dd"), { textContent: texts[i] }));
      list.append(item);
    }
  }

  /** The point for which a measure of its place is least. */
  least(measure) {
    let found = this.chosen, least = Infinity;
    for (let i = 0; i < this.data.x.length; i++) {
      if (this.data.y[i] === null) continue; // it has no such number
      const far = measure(...this.at(i));
      if (far < least) [found, least] = [i, far];
    }
    return found;
  }

  follow(event) {
    const box = document.querySelector("#map svg").getBoundingClientRect(), up = this.data.along ? 0.05 : 1;
    const [px, py] = [event.clientX - box.left, event.clientY - box.top];
    this.choose(this.least((x, y) => Math.hypot(x - px, up * (y - py))));
  }

  /** The next point in the direction of an arrow key. */
  key(event) {
    const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (!way) return;
    event.preventDefault();
    const [px, py] = this.at(this.chosen);
    this.choose(this.least((x, y) => {
      const along = (x - px) * way[0] + (y - py) * way[1], aside = Math.abs((x - px) * way[1]) + Math.abs((y - py) * way[0]);
      return along > 0.5 ? along + (this.data.along ? 0.01 : 3) * aside : Infinity;
    }));
  }
}

async function begin() {
  window.explorer = new Explorer(await received());
}

window.ready = begin();
