// Sliders, time and readouts of the interactive model.

function show(root) {
  const part = (name) => root.querySelector(`[data-model="${name}"]`);
  const choices = ["r0", "bar", "ell", "opposite", "first", "second", "order", "rate", "speed"];
  const controls = Object.fromEntries([...choices, "push-x", "push-y", "time"].map((name) => [name, part(name)]));
  const canvases = { space: part("space"), top: part("top"), length: part("length") };
  const longest = Number(controls.time.max); // s
  const eye = { azimuth: -1.25, elevation: 0.3 };
  let now = 0, playing = false, frame = 0, last = null, setting = null, run = null;

  const number = (name) => Number(controls[name].value);
  const shown = (layer) => part(`show-${layer}`).checked && (layer === "exact" || run.paired);

  function choose() {
    const opposite = controls.opposite.checked;
    if (opposite) controls.second.value = -number("first");
    controls.second.disabled = opposite;
    const [mass, inertia] = controls.bar.value.split(" ").map(Number); // kg, kg m²
    const next = {
      r0: number("r0"), mass, inertia, ell: number("ell"), spins: [number("first"), number("second")],
      order: number("order"), printed: controls.rate.value === "printed",
    };
    if (JSON.stringify(next) !== JSON.stringify(setting)) {
      setting = next;
      begin();
    }
    const unit = (name, digits, of) => { part(`${name}-value`).textContent = `${fixed(number(name), digits)}${of}`; };
    unit("r0", 3, "");
    unit("ell", 2, "");
    unit("first", 1, " rad/s");
    unit("second", 1, " rad/s");
    unit("speed", 2, " ×");
    const spins = `spins ${setting.spins.map((spin) => fixed(spin, 1)).join(" and ")} rad/s, amplitude ${fixed(setting.r0, 3)}`;
    canvases.space.setAttribute("aria-label", `The pair in space: two wheels on axes, the bar between their tips, and the paths `
      + `of the tips; ${spins}. The arrow keys turn it; the table below has its numbers`);
    controls.order.disabled = controls.rate.disabled = !run.paired;
    for (const layer of ["series", "paper"]) part(`show-${layer}`).disabled = !run.paired;
    redraw();
  }

  // The choice's run, without a shock.
  function begin() {
    run = motion(setting);
  }

  // The run after an impulse on tip 1 at a time of the run shown, from there on; none where that has ended before.
  function strike(time, x, y) {
    const next = [time, x, y].every(Number.isFinite) && time >= 0 ? run.after(time, [x, y, 0]) : null;
    if (!next) return;
    [run, now] = [next, 0];
  }

  // Written only where it changes, so that a screen reader stays quiet while the pair moves.
  function say(name, words) {
    if (part(name).textContent !== words) part(name).textContent = words;
  }

  function note(exact) {
    const said = [];
    if (run.impulse) {
      said.push(`After a shock of ${fixed(run.impulse[0], 2)} and ${fixed(run.impulse[1], 2)} N s along x and y on tip 1: the exact `
        + "motion after the shock. Moving a slider restarts the run.");
    } else if (setting.spins.every((spin) => spin === 0)) {
      said.push("Without spin the pair stays at rest where it is placed.");
    } else if (!run.paired) {
      said.push("The paper's formula and the series hold for opposite spins only. The exact model is shown; it starts as a "
        + "small oscillation.");
    } else {
      if (!run.periodic) said.push("No periodic orbit is known: the exact run starts with the initial state of the series.");
      if (run.undecided > 0.01) {
        const moved = `its last two orders change the position of a tip by ${fixed(run.undecided, 2)} m`;
        said.push(run.diverges ? `The series diverges here: ${moved}, more than the two before them.`
          : `The series converges slowly here: ${moved}.`);
      }
      if (setting.ell !== 1 || setting.mass > 0) said.push("The paper's formula assumes a massless bar as long as an axis.");
    }
    if (!exact) said.push(`The exact run ends at ${fixed(run.exact.end, 2)} s: an axis reached the joint line.`);
    say("note", said.join(" "));
  }

  // Axes of one layer at the time shown, its paths and bar lengths over the window; null where it has ended.
  function layerAt(layer, [from, to]) {
    const paths = (of) => [0, 1].map((i) => of.map((axes) => tips(axes, setting.ell)[i]));
    const lengths = (of) => of.map(([t, axes]) => [t, barLength(axes, setting.ell)]);
    if (layer === "exact") {
      run.exact.reach(to);
      const at = run.exact.at(now), first = Math.floor(from / run.exact.h);
      const kept = run.exact.axes.slice(first, Math.ceil(to / run.exact.h) + 1);
      const shorter = run.periodic ? kept.slice(-Math.ceil(run.turn / run.exact.h) - 1) : kept;
      const timed = kept.map((axes, i) => [(first + i) * run.exact.h, axes]);
      return at && { layer, ...at, paths: paths(shorter), lengths: lengths(timed) };
    }
    const spread = (low, high) => Array.from({ length: 217 }, (_, i) => low + (high - low) * i / 216);
    const own = 2 * Math.PI / Math.abs(run[`${layer}Rate`]);
    const timed = spread(from, to).map((t) => [t, run[layer](t)]);
    return { layer, axes: run[layer](now), paths: paths(spread(0, own).map(run[layer])), lengths: lengths(timed) };
  }

  function read(layers) {
    const exact = layers.exact;
    for (const layer of LAYERS) {
      const found = layers[layer], put = (name, words) => say(`${layer}-${name}`, words);
      const length = found ? barLength(found.axes, setting.ell) : NaN;
      put("length", fixed(length, 6));
      put("error", small(length - setting.ell));
      for (const i of [0, 1]) {
        if (layer !== "exact") put(`tip-${i + 1}`, small(found && exact ? apart(found.axes, exact.axes, i) : NaN));
      }
    }
    part("exact-rate").textContent = fixed(
      run.paired && run.periodic ? Math.abs(run.exactRate) : measuredRate(run.exact), 5
    );
    part("series-rate").textContent = fixed(run.paired ? Math.abs(run.seriesRate) : NaN, 5);
    part("paper-rate").textContent = fixed(run.paired ? Math.abs(run.paperRate) : NaN, 5);
    part("natural").textContent = fixed(run.natural, 5);
    const turns = Number.isFinite(run.turn) ? ` = ${fixed(now / run.turn, 2)} turns` : "";
    part("time-value").textContent = `${fixed(now, 2)} s${turns}`;
    controls.time.value = now;
  }

  function draw() {
    const wide = Math.min(3 * run.turn, longest), window = [Math.max(now - wide, 0), Math.max(now, wide)];
    const found = Object.fromEntries(
      LAYERS.filter((layer) => layer === "exact" || run.paired).map((layer) => [layer, layerAt(layer, window)])
    );
    const layers = LAYERS.filter((layer) => found[layer] && shown(layer)).map((layer) => found[layer]);
    const style = getComputedStyle(root);
    const names = ["ink", "faint", "grid", "exact", "series", "paper", "first", "second", "mark"];
    const colours = Object.fromEntries(names.map((name) => [name, style.getPropertyValue(`--model-${name}`).trim()]));
    // Room from above for what the exact tips have done and the paper's formula does.
    const swing = setting.r0 + setting.r0 ** 2, reach = [setting.ell / 2 + swing, Math.max(swing, 0.15)];
    for (const end of run.exact.axes.flatMap((axes) => tips(axes, setting.ell))) {
      reach[0] = Math.max(reach[0], Math.abs(end[0]));
      reach[1] = Math.max(reach[1], Math.abs(end[1]));
    }
    const view = { layers, ell: setting.ell, reach, time: now, window, ...eye };
    drawSpace(canvases.space, view, colours);
    drawTop(canvases.top, view, colours);
    drawLength(canvases.length, view, colours);
    read(found);
    note(found.exact);
  }

  function redraw() {
    if (!frame) frame = requestAnimationFrame(tick);
  }

  function tick(stamp) {
    frame = 0;
    if (playing && last !== null) now += Math.min(stamp - last, 100) / 1000 * number("speed");
    last = playing ? stamp : null;
    if (now >= longest) {
      now = longest;
      play(false);
    }
    draw();
    if (playing) redraw();
  }

  function play(on) {
    if (on && now >= longest) now = 0;
    playing = on;
    last = null;
    part("play").textContent = on ? "Pause" : "Play";
    if (on) redraw();
  }

  for (const name of choices) controls[name].addEventListener("input", choose);
  for (const layer of LAYERS) part(`show-${layer}`).addEventListener("input", redraw);
  controls.time.addEventListener("input", () => {
    play(false);
    now = number("time");
    redraw();
  });
  part("play").addEventListener("click", () => play(!playing));
  part("strike").addEventListener("click", () => {
    strike(now, number("push-x"), number("push-y"));
    redraw();
  });
  part("again").addEventListener("click", () => {
    begin();
    now = 0;
    redraw();
  });

  function turnEye(right, up) {
    eye.azimuth -= right;
    eye.elevation = Math.max(-0.2, Math.min(Math.PI / 2, eye.elevation + up));
    redraw();
  }
  const space = canvases.space;
  let grip = [0, 0];
  space.addEventListener("pointerdown", (event) => {
    space.setPointerCapture(event.pointerId);
    grip = [event.clientX, event.clientY];
  });
  space.addEventListener("pointermove", (event) => {
    if (!space.hasPointerCapture(event.pointerId)) return;
    turnEye((event.clientX - grip[0]) / 120, (event.clientY - grip[1]) / 120);
    grip = [event.clientX, event.clientY];
  });
  const KEYS = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] };
  space.addEventListener("keydown", (event) => {
    if (!KEYS[event.key]) return;
    event.preventDefault();
    turnEye(...KEYS[event.key]);
  });

  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
  new ResizeObserver(redraw).observe(root);
  // It plays by itself only where it is seen and motion is welcome, and rests while it is scrolled away.
  const still = matchMedia("(prefers-reduced-motion: reduce)");
  let waiting = !still.matches;
  new IntersectionObserver(([entry]) => {
    if (entry.isIntersecting && waiting) {
      waiting = false;
      play(true);
    } else if (!entry.isIntersecting && playing) {
      waiting = true;
      play(false);
    }
  }, { threshold: 0.2 }).observe(space);
  choose();
}
