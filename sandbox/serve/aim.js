// Aiming on the picture: the path as it will be, similar shots, the pull by which a player aims.
//
// A second implementation of the pull (window/aim.py), for a finger; the speeds of a pull come from Python.

const SHORTEST_PULL = 60, CLICK = 8; // px on the screen: a full pull is never shorter, a pull is never as short
const FULL = 0.42; // of the picture's height: a full pull
const TOUCH = 26; // px on the screen around a ball by which it is taken
const BORDER = 4; // px that a full pull leaves free before the window's edge
const EDGE = 0.02; // of the picture: a path nearer to its edge is out of sight
const SMALL = 0.5; // of the picture: a smaller path is seen from nearer

class Aim extends Player {
  constructor(data, hands) {
    super(data);
    this.hands = hands; // what is done when the player aims, lets go, turns
  }

  /** The headline is beside the picture, which is as large as its room allows. */
  heading() {}

  resized() {
    super.resized();
    const [width, height] = this.across;
    this.canvas.style.setProperty("--ratio", width / height);
  }

  /** Tell what came of a shot once it is seen, and large for a moment. */
  verdict(word) {
    clearTimeout(this.called);
    $("called").hidden = !word;
    $("called").textContent = this.data.verdict;
    $("called").dataset.verdict = word;
    if (word) this.called = setTimeout(() => this.verdict(""), VERDICT);
  }

  now() {
    super.now();
    if (this.watched) this.hands?.seen(this.t >= this.data.told, this.t >= this.data.duration && !this.playing);
  }

  /** Take a run that is aimed with: it begins, and its whole path is shown. */
  aim(data) {
    this.load(data);
    this.watched = false;
    this.t = 0;
    this.resized();
  }

  /** Take a run that was let go, and play it. */
  watch(data) {
    this.load(data);
    this.watched = true;
    this.resized();
    this.seek(0);
    this.play();
  }

  /** A path that is only aimed with is not played. */
  play() {
    if (this.watched) super.play();
  }

  seek(t) {
    if (this.watched) super.seek(t);
  }

  /** The ends of the path along both axes, as shares of the picture. */
  get ends() {
    return this.view.size.map((size, axis) => {
      const at = this.main.line.map((point) => point[axis] / size);
      return [Math.min(...at), Math.max(...at)];
    });
  }

  /** The size of the path, as a share of the picture. */
  get extent() {
    return Math.max(...this.ends.map(([low, high]) => high - low));
  }

  /** True if the whole path is seen, and large enough. */
  get inSight() {
    return this.ends.every(([low, high]) => low > EDGE && high < 1 - EDGE) && this.extent > SMALL * (this.reach || 0);
  }

  // -------------------------------------------------------------------------------------------- drawing

  beneath() {
    const { context, data, fan } = this;
    if (!fan || this.watched) return;
    for (const scores of [false, true]) {
      context.beginPath();
      for (const [scored, line] of fan.lines) {
        if (scored !== scores) continue;
        for (let i = 0; i < line.length; i += 2) context[i ? "lineTo" : "moveTo"](...this.spot(this.main, line[i], line[i + 1]));
      }
      Object.assign(context, { lineWidth: 1.5 * this.view.unit, strokeStyle: scores ? data.good : "#f4f6f8" });
      context.globalAlpha = fan.late ? 0.12 : 0.35; // that of a moment ago
      context.stroke();
      context.globalAlpha = 1;
    }
  }

  above() {
    const { context, pull, data, shown } = this;
    if (this.hands?.inHand() && !this.watched) {
      const at = this.onScreen(this.spot(this.main, ...this.main.path.state(0).slice(0, 2))).map((value) => value / shown);
      context.setLineDash([6 / shown, 5 / shown]);
      this.circle(...at, TOUCH / shown, data.accent, 2 / shown);
      context.setLineDash([]);
    }
    if (!pull) return;
    const [from, to] = [pull.start, pull.at].map((at) => at.map((value) => value / shown));
    for (const [width, colour] of [[5, data.rim], [2.5, data.accent]]) {
      context.beginPath();
      context.moveTo(...from);
      context.lineTo(...to);
      Object.assign(context, { lineWidth: width / shown, strokeStyle: colour, lineCap: "round" });
      context.stroke();
      for (const [place, radius] of [[from, 3], [to, 7]]) {
        context.beginPath();
        context.arc(...place, radius / shown, 0, 2 * Math.PI);
        context.stroke();
      }
    }
  }

  // -------------------------------------------------------------------------------------------- by hand

  pointer() {
    const { canvas } = this;
    canvas.addEventListener("pointerdown", (event) => {
      if (event.button || !this.hands?.may()) return;
      canvas.setPointerCapture(event.pointerId);
      const start = this.inside(event);
      if (this.takes(start)) return (this.taken = event.pointerId);
      this.pull = { start, at: start, last: start, fine: [0, 0], id: event.pointerId };
      [this.pointed, this.hint.hidden] = [null, true];
    });
    canvas.addEventListener("pointermove", (event) => {
      if (this.taken === event.pointerId) return this.hands.place(this.world(this.under(event)));
      if (!this.pull) return this.data.hidden || this.follow(event);
      if (event.pointerId === this.pull.id) this.pulled(event);
    });
    canvas.addEventListener("pointerup", (event) => {
      const { pull } = this;
      this.taken = null;
      if (!pull || event.pointerId !== pull.id) return;
      this.pull = null;
      if (this.length(pull) >= CLICK) this.hands.shoot();
      else if (this.watched) [this.pointed = this.nearest(...this.under(event)), this.go()];
      this.draw();
    });
    canvas.addEventListener("pointercancel", () => this.cancel());
    canvas.addEventListener("pointerleave", (event) => this.pull || this.left(event));
    canvas.addEventListener("wheel", (event) => {
      if (document.activeElement !== canvas || !this.hands?.may()) return;
      event.preventDefault();
      this.hands.spin(event.shiftKey ? 1 : 0, event.deltaY < 0 || event.deltaX < 0 ? 1 : -1);
    }, { passive: false });
  }

  /** The place in m of a place in px of the layer. */
  world([px, py]) {
    const { at, anchor, scale, stretch } = this.view;
    return [at[0] + (px - anchor[0]) / scale, at[1] - (py - anchor[1]) / (scale * stretch)];
  }

  /** True if a ball that is in the player's hand is touched. */
  takes(start) {
    if (!this.hands.inHand() || this.watched) return false;
    const [x, y] = this.onScreen(this.spot(this.main, ...this.main.path.state(0).slice(0, 2)));
    return Math.hypot(x - start[0], y - start[1]) < TOUCH;
  }

  /** Stop pulling, without a shot. */
  cancel() {
    this.pull = this.taken = null;
    this.draw();
  }

  length({ start, at }) {
    return Math.hypot(at[0] - start[0], at[1] - start[1]);
  }

  /** Pull on; with Shift by a tenth of the way. */
  pulled(event) {
    const { pull } = this, now = this.inside(event), share = event.shiftKey ? 0.1 : 1;
    pull.at = pull.at.map((value, axis) => value + share * (now[axis] - pull.last[axis]));
    pull.last = now;
    const along = pull.at[0] - pull.start[0], down = pull.at[1] - pull.start[1], length = this.length(pull);
    if (length < CLICK) return this.draw();
    const box = this.canvas.getBoundingClientRect(), ends = [[box.left, innerWidth], [box.top, innerHeight]];
    let room = Infinity; // px until the window's edge
    ends.forEach(([offset, end], axis) => {
      const by = axis ? down : along, at = offset + pull.start[axis];
      if (by) room = Math.min(room, ((by > 0 ? end - at : at) - BORDER) * length / Math.abs(by));
    });
    const full = Math.max(SHORTEST_PULL, Math.min(FULL * this.canvas.clientHeight, room));
    const [x, y] = this.view.turned ? [-down, along] : [along, down]; // along the axes of the layer
    const angle = (Math.atan2(y / this.view.stretch, -x) * 180) / Math.PI;
    this.hands.pull(Math.min(1, Math.max(0, (length - CLICK) / (full - CLICK))), angle);
    this.draw();
  }

  keys() {
    super.keys();
    const turn = (by) => (event) => this.hands.turn(event.shiftKey ? by / 10 : by);
    const push = (by) => (event) => this.hands.push(event.shiftKey ? by / 10 : by);
    const commands = {
      ArrowLeft: turn(1), ArrowRight: turn(-1), ArrowUp: push(1), ArrowDown: push(-1), Enter: () => this.hands.shoot(),
      Escape: () => (this.pull ? this.cancel() : this.hands.again()),
    };
    this.canvas.addEventListener("keydown", (event) => {
      const command = commands[event.key];
      if (!command || event.ctrlKey || event.altKey || event.metaKey) return;
      event.preventDefault();
      event.stopPropagation();
      if (event.key === "Escape" || this.hands.may()) command(event);
    });
  }
}
