// The line to the server. Messages are JSON; what was computed comes deflated. A line that is lost comes back by itself.

const SOONEST = 500, LATEST = 5000; // ms until it is tried again
const EVERY = 33; // ms between two questions of a kind: the server reads 40 messages a second
const FINAL = new Set([1008]); // refused: trying again would not help

class Wire {
  /** `hello` makes the first message; `heard` has what is done with each kind. */
  constructor(hello, heard) {
    Object.assign(this, { hello, heard, wait: SOONEST });
    this.connect();
  }

  connect() {
    const socket = (this.socket = new WebSocket(`ws://${location.host}${location.pathname}talk`));
    socket.binaryType = "arraybuffer";
    let last = Promise.resolve(); // messages are read one after the other
    let opened = false;
    socket.onopen = () => {
      opened = true;
      this.wait = SOONEST;
      this.state(true, "");
      this.send(this.hello());
    };
    socket.onmessage = ({ data }) => {
      last = last.then(() => this.read(data)).catch((error) => console.error(error));
    };
    socket.onclose = ({ code, reason }) => {
      if (this.socket !== socket) return;
      this.state(false, reason);
      if (FINAL.has(code) || reason.startsWith("opened")) return;
      setTimeout(() => this.connect(), this.wait);
      this.wait = Math.min(2 * this.wait, LATEST);
      if (!opened) this.ask();
    };
  }

  /** Say so if there is a server again that does not know this address. */
  async ask() {
    const { status } = await fetch(location.pathname, { method: "HEAD" }).catch(() => ({}));
    if (status === 404 && !this.open) this.state(false, "this address is no longer valid; ask for the new one");
  }

  /** Say on the page whether the line is there. */
  state(there, why) {
    $("state").hidden = there;
    $("state").textContent = why ? `connection closed: ${why}` : "connection lost; trying again ...";
  }

  async read(data) {
    let message = data;
    if (typeof data === "string") message = JSON.parse(data);
    else message = await new Response(new Blob([data]).stream().pipeThrough(new DecompressionStream("deflate"))).json();
    await this.heard[message.is]?.(message);
  }

  get open() {
    return this.socket.readyState === WebSocket.OPEN;
  }

  send(message) {
    if (this.open) this.socket.send(JSON.stringify(message));
  }
}

/** Asks for one thing at a time: while an answer is awaited, only the newest question is kept. */
class Latest {
  constructor(wire, kind) {
    Object.assign(this, { wire, kind, awaited: 0, next: null, sent: -EVERY });
  }

  ask(message) {
    this.next = message;
    this.pump();
  }

  pump() {
    if (!this.next || (this.awaited && performance.now() - this.sent < 2000)) return;
    const early = this.sent + EVERY - performance.now();
    if (early > 0) {
      clearTimeout(this.late);
      this.late = setTimeout(() => this.pump(), early);
      return;
    }
    this.awaited = ++Latest.number;
    this.sent = performance.now();
    this.wire.send({ do: this.kind, n: this.awaited, ...this.next });
    this.next = null;
    clearTimeout(this.late);
    this.late = setTimeout(() => this.pump(), 2100);
  }

  /** True if an answer is that to the last question. */
  answered(n) {
    if (n !== this.awaited) return false;
    this.awaited = 0;
    this.pump();
    return true;
  }

  /** What was asked is not awaited any more. */
  forget() {
    this.awaited = 0;
    this.next = null;
  }
}
Latest.number = 0;

/** A line in place of the picture, until it is there; the picture where it is empty. */
function waiting(line) {
  $("waiting").firstElementChild.textContent = line;
  $("waiting").hidden = !line;
}

/** The room for the picture on the page, in px across and down. */
function room() {
  const { clientWidth } = $("picture").parentElement, tall = parseFloat(getComputedStyle($("picture").parentElement).maxHeight);
  return [clientWidth, tall].map((size) => Math.min(4000, Math.max(100, Math.round(size) || 0)));
}

const NEARLY = 0.85; // of a room: one that is smaller or larger by less may keep the picture of the other

/** True if a stage was composed for the page as it is held now. */
const fits = (stage) => room().every((size, axis) => Math.min(size, stage.room[axis]) >= NEARLY * Math.max(size, stage.room[axis]));

/** A stage as it came, with its images. */
async function staged(stage) {
  stage.views = [stage.view];
  await decode(stage);
  return stage;
}

/** A run on a stage, as the player takes it. */
function onStage(stage, run, ghosts) {
  const still = { forces: { times: [0, 1], causes: [] }, longest: { fastest: 0, strongest: 0 } };
  return { ...stage, ...still, ...run, ghosts };
}
