// Charts on canvases.

/** A canvas as sharp as the screen: its context, its size in CSS px and the colour of text. */
function sheet(canvas) {
  const density = Math.max(1, devicePixelRatio || 1), [wide, tall] = [canvas.clientWidth, canvas.clientHeight];
  [canvas.width, canvas.height] = [Math.round(wide * density), Math.round(tall * density)];
  const context = canvas.getContext("2d");
  context.setTransform(density, 0, 0, density, 0, 0);
  context.font = '12px "Sandbox Sans", "Noto Sans", sans-serif';
  const ink = (context.fillStyle = getComputedStyle(canvas).color);
  return { context, wide, tall, ink };
}

/** A histogram: bars of shots that score, and of the rest on them. */
function drawBars(canvas, good, rest, [low, high]) {
  const { context, wide, tall, ink } = sheet(canvas), foot = 16;
  const most = Math.max(1, ...good.map((count, i) => count + rest[i])), each = wide / good.length;
  good.forEach((count, i) => {
    let top = tall - foot;
    for (const [number, colour] of [[count, "#2bb673"], [rest[i], "#8a99a6"]]) {
      const height = (number / most) * (tall - foot);
      context.fillStyle = colour;
      context.fillRect(i * each + 0.5, top - height, each - 1, height);
      top -= height;
    }
  });
  context.fillStyle = ink;
  context.textBaseline = "bottom";
  context.fillText(low, 0, tall);
  context.textAlign = "right";
  context.fillText(high, wide, tall);
}

/** The energy over time by cause, in J, with how much of each is left at the end; the chart goes on a little after an
 *  impact that ends the run, and its end is named where it is. */
function drawEnergy(canvas, legend, { times, end, bands }) {
  const { context, wide, tall } = sheet(canvas), last = times[times.length - 1] || 1, foot = 18;
  const high = Math.max(1e-9, ...bands.flatMap(({ top }) => top));
  const at = (t, joules) => [(t / last) * wide, (tall - foot) * (1 - joules / high)];
  context.textBaseline = "bottom";
  context.fillText("0 s", 0, tall);
  context.textAlign = "right";
  context.fillText(amount(end, "s"), at(end, 0)[0], tall);
  for (const { top, foot: below, colour } of bands) {
    context.beginPath();
    times.forEach((t, i) => context.lineTo(...at(t, top[i])));
    for (let i = times.length - 1; i >= 0; i--) context.lineTo(...at(times[i], below[i] ?? 0));
    context.fillStyle = colour;
    context.fill();
  }
  const energy = (joules) => (joules >= 1000 ? `${(joules / 1000).toFixed(1)} kJ` : joules >= 1 ? `${joules.toFixed(1)} J` : `${Number((1000 * joules).toPrecision(2))} mJ`);
  const entry = (text, colour) => {
    const item = document.createElement("li"), dot = document.createElement("i");
    dot.style.background = colour;
    item.append(...(colour ? [dot] : []), text);
    return item;
  };
  const ends = bands.map(({ name, colour, top, foot: below }) => [name, colour, top[top.length - 1] - (below[below.length - 1] ?? 0)]);
  const left = ends.map(([name, colour, joules]) => entry(joules >= 0.0005 * high ? `${name} ${energy(joules)}` : name, colour));
  legend.replaceChildren(entry(`at the end, of ${energy(high)}:`, ""), ...left);
}
