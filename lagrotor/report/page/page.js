// The page reads without this script; with it there is a search, open contents on a wide screen, and whole folds on paper.

// A query as the words that an entry must hold: "Fig. 7" and "figure 7" are one, "c8" is C08, "5.1" begins 5.10 too.
function words(query) {
  return query
    .toLowerCase()
    .replace(/\b(?:fig(?:ure)?s?\.?)\s*(?=[btm]?\d)/g, "figure-")
    .replace(/\b(?:eqs?\.?|equations?)\s*(?=\d)/g, "")
    .replace(/\b(?:claims?\s*c?|c)0*(\d{1,2})\b/g, (_, number) => "c" + number.padStart(2, "0"))
    .split(/\s+/)
    .filter(Boolean);
}

// Whether two words differ by one letter, or by two neighbours in the other order.
function isTypo(a, b) {
  let [start, end] = [0, 0];
  while (start < a.length && a[start] === b[start]) start++;
  while (end < Math.min(a.length, b.length) - start && a.at(-1 - end) === b.at(-1 - end)) end++;
  const [x, y] = [a, b].map((word) => word.slice(start, word.length - end));
  return Math.max(x.length, y.length) < 2 || (x.length === 2 && x === [...y].reverse().join(""));
}

// The beginning of a word of a text; the φ of a keyboard is the ϕ of formulas, too.
function beginning(word) {
  return "(?<![\\p{L}\\d.])" + word.replace(/[.*+?^${}()|[\]\\]/g, "\\$&").replace("figure-", "figure[- ]").replace(/[φϕ]/g, "[φϕ]");
}

// A word of the query as the words to look for: itself, or those of the entries that it may be a misspelling of, if it has five letters and no entry has it.
function meant(word, entries) {
  const pattern = new RegExp(beginning(word), "iu");
  if (!/^\p{L}{5,}$/u.test(word) || entries.some((entry) => pattern.test(entry.text))) return [word];
  const known = new Set(entries.flatMap((entry) => entry.text.toLowerCase().match(/\p{L}{4,}/gu) ?? []));
  const near = [...known].filter((other) => Math.abs(other.length - word.length) < 2 && isTypo(word, other));
  return near.length ? near : [word];
}

// The entries that have all words of a query, the entry of that number first, and the words that were looked for. An id is met from its beginning.
function search(query, entries) {
  const asked = words(query);
  const sought = asked.map((word) => meant(word, entries));
  const patterns = sought.map((any) => new RegExp(any.map(beginning).join("|"), "iu"));
  const number = (id) => id.replace("erratum-", "");
  const begins = (id) => asked.map((word) => /\d/.test(word) && number(id).startsWith(word));
  const rank = ({ id, name }) =>
    [asked.includes(id), asked.includes(number(id)), begins(id).includes(true), patterns.every((p) => p.test(name)), true].indexOf(true);
  const isFigure = asked.map((word) => word.startsWith("figure-"));
  const meets = ({ id, text }) => begins(id).every((is, i) => is || (!isFigure[i] && patterns[i].test(text)));
  const found = asked.length ? entries.filter(meets).map((entry) => ({ ...entry, rank: rank(entry) })) : [];
  const changed = asked.map((word, i) => [word, sought[i]]).filter(([word, any]) => any[0] !== word);
  return { found: found.sort((a, b) => a.rank - b.rank), sought: sought.flat(), changed };
}

// A text as pieces, of which every second one is a word that was looked for: `size` letters from the first such word, or from the beginning.
function marked(text, sought, size, fromWord) {
  const pattern = `(${sought.map(beginning).join("|")})`;
  const place = fromWord ? Math.max(0, text.search(new RegExp(pattern, "iu")) - size / 3) : 0;
  const start = size < text.length && place ? text.indexOf(" ", place) + 1 : 0;
  const end = start + size < text.length ? text.lastIndexOf(" ", start + size) : text.length;
  const piece = (start ? "… " : "") + text.slice(start, end) + (end < text.length ? " …" : "");
  return piece.split(new RegExp(pattern, "iu"));
}

// What can be found: [address, anchor, title, verdict, words] of each entry, from a file that the first query loads, or from this page, which has the words itself.
function loadWords(script) {
  if (!script.dataset.words) return WORDS.map((row) => [...row, wordsOf(row[1])]);
  if (typeof WORDS !== "undefined") return WORDS;
  return new Promise((resolve, reject) => {
    const loaded = document.createElement("script");
    loaded.src = script.dataset.words;
    loaded.onload = () => resolve(WORDS);
    loaded.onerror = reject;
    document.body.append(loaded);
  });
}

// The words of an entry or a section of this page, without programs, displayed formulas, headings and other entries.
function wordsOf(anchor) {
  const part = document.getElementById(anchor);
  const copy = (part.closest("h2")?.closest("section") ?? part).cloneNode(true);
  const unread = "script, style, pre, h2, h4, summary, math[display], img, article, .derivation, .overview";
  for (const inside of copy.querySelectorAll(unread)) inside.remove();
  for (const block of copy.querySelectorAll("p, dt, dd, th, td, li, h3, figcaption")) block.append(block.tagName === "DT" ? ": " : " ");
  return copy.textContent.replace(/\s+/g, " ").trim();
}

function element(tag, name, ...inside) {
  const made = document.createElement(tag);
  made.className = name;
  made.append(...inside);
  return made;
}

// One row of the list: title, verdict, and a piece of the text with the words marked; its beginning if the title has the words.
function hit({ address, name, answer, plain, rank }, sought) {
  const marks = (pieces) => pieces.map((piece, i) => (i % 2 ? element("mark", "", piece) : piece));
  const anchor = element("a", "", element("span", "", ...marks(marked(name, sought, Infinity, false))));
  if (answer) anchor.append(element("span", "unseen", ","), " ", element("span", `badge ${answer}`, answer.replaceAll("-", " ")));
  anchor.append(" ", element("small", "", ...marks(marked(plain, sought, 150, rank > 3))));
  anchor.href = address;
  return element("li", "", anchor);
}

const MOST = 30; // hits that are listed
function setUpSearch(script) {
  const form = document.getElementById("search");
  const [input, said, hits] = ["query", "found", "hits"].map((id) => document.getElementById(id));
  const up = script.dataset.up ?? "";
  let entries = null;
  async function show() {
    entries ??= (await loadWords(script)).map(([address, anchor, name, answer, plain]) => ({
      id: anchor.replace(/^(eq|claim)-/, "").toLowerCase(),
      text: `${name} ${answer.replaceAll("-", " ")} ${plain}`,
      address: address.startsWith("#") ? address : up + address,
      ...{ name, answer, plain },
    }));
    const { found, sought, changed } = search(input.value, entries);
    hits.replaceChildren(...found.slice(0, MOST).map((entry) => hit(entry, sought)));
    const more = found.length > MOST ? `, the first ${MOST}:` : "";
    const read = changed.map(([word, any]) => `, with ${any.join(" or ")} for ${word}`).join("");
    said.textContent = input.value.trim() && `${found.length} found${read}${more}`;
  }
  form.hidden = false;
  form.addEventListener("input", show);
  form.addEventListener("submit", async (event) => {
    event.preventDefault();
    await show();
    hits.querySelector("a")?.click();
  });
  form.addEventListener("keydown", (event) => {
    const stops = [input, ...hits.querySelectorAll("a")];
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (step) stops[stops.indexOf(document.activeElement) + step]?.focus();
    if (event.key === "Escape") {
      input.value = "";
      input.focus();
      show();
    }
    if (step || event.key === "Escape") event.preventDefault();
  });
}

// On a narrow screen the entries are folded to their headings; that to which a link leads is unfolded.
function setUpFolds() {
  if (matchMedia("(max-width: 40rem)").matches) for (const fold of document.querySelectorAll(".entry")) fold.open = false;
  const reveal = () => {
    const target = location.hash && document.getElementById(decodeURIComponent(location.hash.slice(1)));
    if (!target) return;
    const inner = target.querySelector(":scope > details") ?? target;
    for (let fold = inner.closest("details"); fold; fold = fold.parentElement.closest("details")) fold.open = true;
    target.scrollIntoView();
  };
  addEventListener("hashchange", reveal);
  document.addEventListener("click", (event) => {
    if (location.hash && event.target.closest("a")?.getAttribute("href") === location.hash) reveal();
  });
  reveal();
}

// A figure opens as large as it is drawn, and closes by Escape, the button or a click.
function setUpFigures() {
  const dialog = document.createElement("dialog");
  dialog.innerHTML = '<button type="button">Close</button><div class="large"></div>';
  dialog.setAttribute("aria-label", "Enlarged figure");
  document.body.append(dialog);
  dialog.addEventListener("click", () => dialog.close());
  for (const image of document.querySelectorAll("figure > img, .results img")) {
    image.tabIndex = 0;
    image.setAttribute("role", "button");
    const open = () => {
      const copy = new Image();
      copy.src = image.src;
      copy.alt = image.alt;
      copy.style.height = Math.max(innerHeight, 0.6 * image.height) + "px";
      dialog.querySelector(".large").replaceChildren(copy);
      dialog.showModal();
    };
    image.addEventListener("click", open);
    image.addEventListener("keydown", (event) => {
      if (event.key === "Enter" || event.key === " ") {
        event.preventDefault();
        open();
      }
    });
  }
}

// Two formulas beside each other stand one below the other where one is too wide; a formula wider than its box is drawn smaller, down to letters that can be read; what is then still too wide scrolls. On paper nothing scrolls: there it is drawn as small as it must be.
const SMALLEST = 14.4; // px, of a formula: its scripts have 0.7 of it
const [PAPER, PAPER_TERM] = [680, 128]; // px, the text width of A4, and of that the column of terms of a list
function fitFormulas(part = document) {
  for (const pair of part.querySelectorAll("[data-pair]")) pair.className = "pair";
  for (const box of part.querySelectorAll(".wide")) {
    for (const formula of box.querySelectorAll("math[display=block]")) {
      formula.style.fontSize = "";
      const pair = box.closest(".pair");
      if (pair && formula.scrollWidth > 1.1 * box.clientWidth) {
        pair.className = "stack";
        pair.dataset.pair = "";
      }
      const natural = parseFloat(getComputedStyle(formula).fontSize);
      const room = PAPER - (box.closest("dd") ? PAPER_TERM : 0);
      formula.style.setProperty("--paper", `${Math.min(SMALLEST, (0.93 * room * natural) / formula.scrollWidth)}px`);
      // Letters lean out of their boxes, and smaller ones are wider for their size: a second look. In a list a box is only as wide as its formula: what counts there is the column.
      const column = box.parentElement.matches("dd") ? box.parentElement : box;
      for (let pass = 0, share = 1; box.clientWidth && pass < 2; pass++) {
        share *= Math.min(1, (column.clientWidth - 4) / Math.max(formula.scrollWidth, box.scrollWidth - 4));
        if (share < 1) formula.style.fontSize = Math.max(SMALLEST, share * natural) + "px";
      }
    }
    if (box.scrollWidth > box.clientWidth) box.tabIndex = 0; // the keyboard must reach what scrolls
  }
  for (const formula of part.querySelectorAll("math:not([display=block])")) {
    const line = formula.closest("p, li, td, dd, figcaption, h3");
    if (!line?.clientWidth || formula.getBoundingClientRect().width <= line.clientWidth || formula.closest("span.wide, div.wide:not(:has(table))")) continue;
    const box = document.createElement("span");
    box.className = "wide";
    formula.replaceWith(box);
    box.append(formula);
    box.tabIndex = 0;
  }
}

function setUpPage(script) {
  const contents = document.getElementById("contents");
  const wide = matchMedia("(min-width: 75rem)");
  const unfold = () => (contents.open = wide.matches);
  wide.addEventListener("change", unfold);
  unfold();
  contents.addEventListener("click", (event) => {
    if (event.target.closest("a") && !wide.matches) contents.open = false;
  });
  setUpFolds();
  fitFormulas();
  addEventListener("resize", () => fitFormulas());
  for (const fold of document.querySelectorAll("details")) fold.addEventListener("toggle", () => fitFormulas(fold));
  setUpFigures();
  let opened = [];
  addEventListener("beforeprint", () => {
    opened = [...document.querySelectorAll("details:is(.fold, .entry):not([open])")];
    for (const fold of opened) fold.open = true;
    fitFormulas();
  });
  addEventListener("afterprint", () => {
    for (const fold of opened) fold.open = false;
  });
  setUpSearch(script);
}

if (typeof document !== "undefined") setUpPage(document.currentScript);
