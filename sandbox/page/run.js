// The page of one run.

async function begin() {
  const data = await received();
  const layers = data.views.map(async (view) => {
    for (const name of ["place", "along", "over"]) view[name] = await image(view[name]);
  });
  const skins = data.looks.filter(({ skin }) => skin).map(async (look) => (look.skin = pixels(await image(look.skin))));
  await Promise.all([...layers, ...skins]);
  $("poster").remove();
  $("picture").hidden = false;
  window.player = new Player(data);
}

window.ready = begin();
