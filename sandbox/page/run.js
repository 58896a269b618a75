// The page of one run.

async function begin() {
  const data = await received();
  await decode(data);
  $("poster").remove();
  $("picture").hidden = false;
  window.player = new Player(data);
}

window.ready = begin();
