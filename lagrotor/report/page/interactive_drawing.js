// The pictures and numbers of the interactive model.

const SUPERSCRIPTS = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };

// A small difference: four decimals, or a power of ten; what is lost in rounding is 0.
function small(value) {
  if (!Number.isFinite(value)) return "–";
  if (Math.abs(value) < 2e-15) return "0";
  if (Math.abs(value) >= 1e-3) return fixed(value, 4);
  const [digits, power] = value.toExponential(1).split("e");
  return `${digits.replace("-", "−")}×10${[...power].map((c) => SUPERSCRIPTS[c]).join("")}`;
}

const LAYERS = ["exact", "series", "paper"];
const LOOK = {
  exact: { width: 2, dash: [] },
  series: { width: 5, dash: [], alpha: 0.55 },
  paper: { width: 2, dash: [7, 4] },
};

function tips(axes, ell) {
  return [0, 1].map((i) => [axes[3 * i] + (i - 0.5) * ell, axes[3 * i + 1], axes[3 * i + 2]]);
}

// The mark of a layer at a tip: filled round, open round, open square.
function mark(pen, [x, y], layer, colours) {
  pen.beginPath();
  if (layer === "paper") pen.rect(x - 4.5, y - 4.5, 9, 9);
  else pen.arc(x, y, layer === "exact" ? 4 : 7, 0, 2 * Math.PI);
  pen.strokeStyle = pen.fillStyle = colours[layer];
  pen.lineWidth = 2;
  if (layer === "exact") pen.fill();
  else pen.stroke();
}

// Rim and spokes of a wheel half-way up an axis, carried by the least turn of e_z into it and by its own spin.
function wheel(joint, [x, y, z], turn, radius) {
  const across = [1 - x * x / (1 + z), -x * y / (1 + z), -x], beside = [-x * y / (1 + z), 1 - y * y / (1 + z), -y];
  const centre = [joint[0] + x / 2, joint[1] + y / 2, joint[2] + z / 2];
  const rim = (angle) => centre.map(
    (v, i) => v + radius * (across[i] * Math.cos(turn + angle) + beside[i] * Math.sin(turn + angle))
  );
  const around = Array.from({ length: 49 }, (_, n) => rim(n * Math.PI / 24));
  return { centre, around, spokes: [0, 1, 2, 3, 4].map((n) => [centre, rim(n * 2 * Math.PI / 5)]) };
}

function drawSpace(canvas, view, colours) {
  const { pen, width, height } = sheet(canvas), [right, up, towards] = camera(view.azimuth, view.elevation);
  const joints = [[-view.ell / 2, 0, 0], [view.ell / 2, 0, 0]];
  // The view follows the pair: all that the tips have done, the joints and their labels are in it.
  const seen = [...joints, [0, 0, 1], ...view.layers.flatMap(({ axes, paths }) => [...tips(axes, view.ell), ...paths.flat()])];
  const [wide, high] = [right, up].map((d) => seen.map((p) => dot(p, d)).filter(Number.isFinite));
  const [left, rightmost, lowest, top] = [Math.min(...wide), Math.max(...wide), Math.min(...high), Math.max(...high)];
  const scale = Math.min(width / (rightmost - left + 0.9), height / (top - lowest + 0.55));
  const centre = [(left + rightmost) / 2, (lowest + top) / 2 - 0.06];
  const on = (p) => [
    width / 2 + scale * (dot(p, right) - centre[0]), height / 2 - scale * (dot(p, up) - centre[1]),
  ];
  const far = Math.ceil(2 * (view.ell / 2 + 0.4)) / 2;
  for (let x = -far; x <= far; x += 0.5) line(pen, [on([x, -0.5, 0]), on([x, 0.5, 0])], colours.grid);
  for (let y = -0.5; y <= 0.5; y += 0.5) line(pen, [on([-far, y, 0]), on([far, y, 0])], colours.grid);
  line(pen, joints.map(on), colours.faint, { width: 2 });
  for (const { layer, paths } of view.layers) {
    const look = { ...LOOK[layer], width: LOOK[layer].width * 0.75 };
    for (const path of paths) line(pen, path.map(on), colours[layer], look);
  }
  for (const { layer, axes } of view.layers) {
    if (layer === "exact") continue;
    const ends = tips(axes, view.ell).map(on);
    joints.forEach((joint, i) => line(pen, [on(joint), ends[i]], colours[layer], LOOK[layer]));
    line(pen, ends, colours[layer], LOOK[layer]);
  }
  const exact = view.layers.find((each) => each.layer === "exact");
  if (exact) {
    const ends = tips(exact.axes, view.ell), radius = 0.36 * Math.min(1, view.ell);
    const bodies = joints.map((joint, i) => (
      { joint, i, ...wheel(joint, exact.axes.slice(3 * i), exact.turns[i], radius) }
    ));
    bodies.sort((p, q) => dot(p.centre, towards) - dot(q.centre, towards));
    for (const { joint, i, around, spokes } of bodies) {
      const colour = colours[i ? "second" : "first"];
      pen.beginPath();
      around.map(on).forEach(([x, y], n) => (n ? pen.lineTo(x, y) : pen.moveTo(x, y)));
      pen.fillStyle = colour;
      pen.globalAlpha = 0.18;
      pen.fill();
      pen.globalAlpha = 1;
      line(pen, around.map(on), colour, { width: 2 });
      spokes.forEach((spoke, n) => line(pen, spoke.map(on), n ? colour : colours.mark, { width: n ? 1.2 : 4 }));
      line(pen, [on(joint), on(ends[i])], colours.exact, { width: 2.5 });
    }
    line(pen, ends.map(on), colours.exact, { width: 4 });
  }
  for (const joint of joints) {
    const [x, y] = on(joint);
    pen.fillStyle = colours.exact;
    pen.beginPath();
    pen.moveTo(x, y - 2);
    pen.lineTo(x - 7, y + 10);
    pen.lineTo(x + 7, y + 10);
    pen.fill();
  }
  joints.forEach((joint, i) => {
    const [x, y] = on(joint);
    text(pen, `rotor ${i + 1}`, x, y + 25, colours[i ? "second" : "first"], "center");
  });
  for (const { layer, axes } of view.layers) for (const end of tips(axes, view.ell)) mark(pen, on(end), layer, colours);
  const corner = [30, height - 30];
  ["x", "y", "z"].forEach((name, i) => {
    const tip = [corner[0] + 22 * right[i], corner[1] - 22 * up[i]];
    line(pen, [corner, tip], colours.faint, { width: 1.5 });
    text(pen, name, corner[0] + 31 * right[i], corner[1] - 31 * up[i] + 4, colours.faint, "center");
  });
}

// Round values between low and high, at least 2 and at most 6.
function ticks(low, high) {
  const rough = (high - low) / 6, power = 10 ** Math.floor(Math.log10(rough));
  const gap = power * [1, 2, 5, 10].find((n) => n * power >= rough);
  const values = [];
  for (let n = Math.ceil(low / gap - 1e-9); n * gap <= high + 1e-9 * gap; n++) values.push(n * gap);
  return { values, digits: Math.max(0, -Math.floor(Math.log10(gap) + 1e-9)) };
}

// Frame with ticks and labels; returns where a point goes.
function frame(pen, box, [x0, x1], [y0, y1], [xName, yName], colours) {
  const at = ([x, y]) => [
    box.left + (x - x0) / (x1 - x0) * (box.right - box.left),
    box.bottom - (y - y0) / (y1 - y0) * (box.bottom - box.top),
  ];
  const across = ticks(x0, x1), upward = ticks(y0, y1);
  for (const x of across.values) {
    const [px] = at([x, y0]);
    line(pen, [[px, box.top], [px, box.bottom]], colours.grid);
    text(pen, fixed(x, across.digits), px, box.bottom + 16, colours.faint, "center");
  }
  for (const y of upward.values) {
    const [, py] = at([x0, y]);
    line(pen, [[box.left, py], [box.right, py]], colours.grid);
    text(pen, fixed(y, upward.digits), box.left - 6, py + 4, colours.faint, "right");
  }
  text(pen, xName, (box.left + box.right) / 2, box.bottom + 33, colours.ink, "center");
  text(pen, yName, 4, box.top - 8, colours.ink);
  return at;
}

function clipped(pen, box, draw) {
  pen.save();
  pen.beginPath();
  pen.rect(box.left, box.top, box.right - box.left, box.bottom - box.top);
  pen.clip();
  draw();
  pen.restore();
}

function drawTop(canvas, view, colours) {
  const { pen, width, height } = sheet(canvas);
  const box = { left: 46, right: width - 10, top: 26, bottom: height - 42 };
  const ratio = (box.bottom - box.top) / (box.right - box.left);
  const half = 1.08 * Math.max(view.reach[0], view.reach[1] / ratio), across = half * ratio;
  const at = frame(pen, box, [-half, half], [-across, across], ["x [m]", "y [m]"], colours);
  clipped(pen, box, () => {
    for (const { layer, paths, axes } of [...view.layers].reverse()) {
      for (const path of paths) line(pen, path.map(at), colours[layer], LOOK[layer]);
      line(pen, tips(axes, view.ell).map(at), colours[layer], { ...LOOK[layer], width: LOOK[layer].width * 0.6 });
    }
    for (const x of [-view.ell / 2, view.ell / 2]) {
      const [px, py] = at([x, 0]);
      pen.fillStyle = colours.faint;
      pen.fillRect(px - 4, py - 4, 8, 8);
    }
    for (const { layer, axes } of view.layers) {
      for (const end of tips(axes, view.ell)) mark(pen, at(end), layer, colours);
    }
  });
}

function drawLength(canvas, view, colours) {
  const { pen, width, height } = sheet(canvas);
  const box = { left: 56, right: width - 12, top: 26, bottom: height - 42 };
  const all = view.layers.flatMap(({ lengths }) => lengths.map(([, value]) => value)).filter(Number.isFinite);
  const low = Math.min(view.ell, ...all), high = Math.max(view.ell, ...all);
  const room = Math.max(0.12 * (high - low), 0.005);
  const names = ["time [s]", "length of the bar [m]"];
  const at = frame(pen, box, view.window, [low - room, high + room], names, colours);
  clipped(pen, box, () => {
    for (const { layer, lengths } of [...view.layers].reverse()) {
      line(pen, lengths.map(at), colours[layer], LOOK[layer]);
    }
    line(pen, [[view.time, low - room], [view.time, high + room]].map(at), colours.faint, { dash: [2, 4] });
  });
}
