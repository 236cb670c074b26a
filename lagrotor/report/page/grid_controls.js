// The board, the verdict in words, and the plan in which the tips move after a push.

const KINDS = ["plus", "minus", "still", "none"];
const SIGNS = { plus: "+", minus: "−", still: "0", none: "·" };
const WORDS = { plus: "spins in the positive sense", minus: "spins in the negative sense", still: "does not spin", none: "empty" };
const NEAR = 0.02; // of the fast rate: the largest detuning that is spoken of
const EXAMPLES = { // of each place, from below, left to right; bars along x and along y by the place where they begin
  corner: [["plus", "plus", "none", "none", "plus", "none", "none", "none", "none"], [0], [1]],
  square: [["minus", "plus", "none", "plus", "plus", "none", "none", "none", "none"], [0, 3], [0, 1]],
  grid: [["minus", "plus", "plus", "plus", "minus", "plus", "plus", "plus", "minus"], [0, 1, 3, 4, 6, 7], [0, 1, 2, 3, 4, 5]],
  pair: [["plus", "minus", ...Array(7).fill("none")], [0], []],
};

// The verdict and its reason, in words.
function verdict(found, spin) {
  const number = (x) => x.toPrecision(3), dof = found.rows.length + found.columns.length;
  if (!dof) return ["There is no rotor.", ""];
  if (found.stands) {
    const bounded = `Its linear motion, of ${dof} degrees of freedom, stays bounded from ${number(found.factor)} times these spins on.`;
    const { off, fast, slow } = found.resonance;
    if (off > NEAR) return ["It stands to first order.", bounded];
    return ["It stands to first order, near a resonance.", `${bounded} But two slow precessions, of ${slow.map(number).join(" and ")} rad/s, add up to a fast one, `
      + `of ${number(fast)}: they may feed each other, and any push then falls. Structure(…).stands() decides whether they do.`];
  }
  const falls = `It falls: a small tilt grows e-fold in ${number(1 / found.growth)} s.`;
  if (!spin) return [falls, "Nothing turns."];
  if (!found.free) return [falls, `It stands from ${number(found.factor)} times these spins on.`];
  const uneven = found.alone ? `the bars leave ${found.rows.length} motions along x and ${found.columns.length} along y; spin `
    + "holds them in pairs only" : "the spins cancel on one of the motions that the bars leave";
  return [falls, `No multiple of these spins holds it: ${uneven}.`];
}

function showGrid(root) {
  const part = (name) => root.querySelector(`[data-grid="${name}"]`);
  const board = part("board"), plan = part("plan"), places = Array.from({ length: SIDE * SIDE }, (_, i) => i);
  let kinds = [], right = new Set(), up = new Set(), found = null, moving = 0;
  const spins = () => kinds.map((kind) => ({ plus: 1, minus: -1, still: 0, none: null })[kind]).map((sign) => sign && sign * Number(part("spin").value));
  const buttons = new Map();

  function add(name, className, column, row, press) {
    const button = document.createElement("button");
    button.type = "button";
    button.className = className;
    button.style.gridColumn = column;
    button.style.gridRow = row;
    button.addEventListener("click", () => { press(); show(); });
    board.append(button);
    buttons.set(name, button);
  }
  for (const i of [...places].sort((i, j) => Math.floor(j / SIDE) - Math.floor(i / SIDE) || i - j)) {
    const column = 2 * (i % SIDE) + 1, row = 2 * (SIDE - 1 - Math.floor(i / SIDE)) + 1;
    const toggle = (bars) => () => { if (!bars().delete(i)) bars().add(i); };
    add(`rotor ${i}`, "grid-rotor", column, row, () => { kinds[i] = KINDS[(KINDS.indexOf(kinds[i]) + 1) % KINDS.length]; });
    if (i % SIDE < SIDE - 1) add(`right ${i}`, "grid-bar", column + 1, row, toggle(() => right));
    if (i < SIDE * (SIDE - 1)) add(`up ${i}`, "grid-bar grid-across", column, row - 1, toggle(() => up));
  }

  const name = (i) => `row ${Math.floor(i / SIDE) + 1} from below, place ${i % SIDE + 1}`;
  function bar(key, bars, i, next) {
    const button = buttons.get(`${key} ${i}`);
    if (!button) return;
    button.disabled = kinds[i] === "none" || kinds[i + next] === "none";
    if (button.disabled) bars.delete(i);
    button.setAttribute("aria-pressed", bars.has(i));
    button.setAttribute("aria-label", `Bar from ${name(i)} to ${name(i + next)}`);
  }

  function show() {
    for (const i of places) {
      const button = buttons.get(`rotor ${i}`);
      button.textContent = SIGNS[kinds[i]];
      button.dataset.kind = kinds[i];
      button.setAttribute("aria-label", `${name(i)}: ${WORDS[kinds[i]]}`);
      bar("right", right, i, 1);
      bar("up", up, i, SIDE);
    }
    part("spin-value").textContent = `${part("spin").value} rad/s`;
    part("load-value").textContent = `${part("load").value} kg`;
    found = standing(spins(), [...right], [...up], Number(part("load").value));
    [part("verdict").textContent, part("why").textContent] = verdict(found, spins().some((spin) => spin));
    plan.setAttribute("aria-label", `The joints and the tips from above. ${part("verdict").textContent} ${part("why").textContent}`);
    part("push").disabled = !found.rows.length;
    cancelAnimationFrame(moving);
    draw({});
  }

  // Tilts are drawn as long as they are; one as wide as a metre ends the run.
  function draw(tilts) {
    const scale = window.devicePixelRatio || 1, wide = plan.clientWidth, unit = wide / 4;
    [plan.width, plan.height] = [wide * scale, plan.clientHeight * scale];
    const pen = plan.getContext("2d"), style = getComputedStyle(root);
    const at = (i, [x, y] = tilts[i] ?? [0, 0]) => [(1 + i % SIDE + x) * unit, plan.clientHeight - (1 + Math.floor(i / SIDE) + y) * unit];
    pen.scale(scale, scale);
    const stroke = (from, to, width, colour) => {
      pen.beginPath();
      pen.moveTo(...from);
      pen.lineTo(...to);
      [pen.lineWidth, pen.strokeStyle] = [width, style.getPropertyValue(colour)];
      pen.stroke();
    };
    for (const [bars, next] of [[right, 1], [up, SIDE]]) for (const i of bars) stroke(at(i), at(i + next), 4, "--grid-line");
    for (const i of places.filter((each) => kinds[each] !== "none")) {
      const colour = { plus: "--grid-plus", minus: "--grid-minus", still: "--grid-ink" }[kinds[i]];
      stroke(at(i, [0, 0]), at(i), 3, colour);
      pen.beginPath();
      pen.arc(...at(i), 5, 0, 2 * Math.PI);
      pen.fillStyle = style.getPropertyValue(colour);
      pen.fill();
    }
  }

  function push() {
    cancelAnimationFrame(moving);
    const motion = stepper(found, spins());
    let y = motion.pushed(), last = null, left = 12; // s
    const tick = (stamp) => {
      const passed = Math.min((stamp - (last ?? stamp)) / 1000, 0.05);
      for (let k = 0; k < 20; k++) y = motion.step(y, passed / 20);
      [last, left] = [stamp, left - passed];
      const tilts = motion.tilts(y);
      draw(tilts);
      if (left > 0 && Object.values(tilts).every(([x, z]) => Math.hypot(x, z) < 1)) moving = requestAnimationFrame(tick);
    };
    moving = requestAnimationFrame(tick);
  }

  function begin() {
    const [of, along, across] = EXAMPLES[part("example").value];
    [kinds, right, up] = [[...of], new Set(along), new Set(across)];
    show();
  }
  part("example").addEventListener("input", begin);
  for (const control of ["spin", "load"]) part(control).addEventListener("input", show);
  part("push").addEventListener("click", push);
  begin();
}
