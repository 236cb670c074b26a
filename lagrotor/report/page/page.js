// The page reads without this script; with it there is a search, open contents on a wide screen, and whole folds on paper.

// Text as it is compared: in small letters, and with the φ of a keyboard for the ϕ of formulas.
function searchable(text) {
  return text.toLowerCase().replaceAll("ϕ", "φ");
}

// A query as the words that an entry must hold: "Fig. 7" and "figure 7" are one, "c8" is C08, "5.1" begins 5.10 too.
function words(query) {
  return searchable(query)
    .replace(/\b(?:fig(?:ure)?s?\.?)\s*(?=[btm]?\d)/g, "figure-")
    .replace(/\b(?:eqs?\.?|equations?)\s*(?=\d)/g, "")
    .replace(/\b(?:claims?\s*c?|c)0*(\d{1,2})\b/g, (_, number) => "c" + number.padStart(2, "0"))
    .split(/\s+/)
    .filter(Boolean);
}

// Whether an entry is meant: an id (or a figure's name) from its beginning, any other word anywhere.
function matches(sought, id, text) {
  return sought.every((word) => (/\d/.test(word) && id.startsWith(word)) || (!/^figure-/.test(word) && text.includes(word)));
}

// Those of the entries that are meant, an id that is met exactly first.
function search(query, entries) {
  const sought = words(query);
  const found = sought.length ? entries.filter((entry) => matches(sought, entry.id, entry.text)) : [];
  const exact = (entry) => Number(sought.includes(entry.id));
  return found.map((entry, i) => [entry, i]).sort(([a, i], [b, j]) => exact(b) - exact(a) || i - j).map(([entry]) => entry);
}

// What can be found: [address, anchor, name, words] of each entry, in a file that is loaded at the first query or in this page.
function loadWords(script) {
  if (typeof WORDS !== "undefined") return WORDS;
  if (!script.dataset.words) return wordsOfPage();
  return new Promise((resolve, reject) => {
    const loaded = document.createElement("script");
    loaded.src = script.dataset.words;
    loaded.onload = () => resolve(WORDS);
    loaded.onerror = reject;
    document.body.append(loaded);
  });
}

// The entries of a page that holds the whole report, then its sections without their entries.
function wordsOfPage() {
  const entries = "article[id], figure[id], details.derivation";
  return [entries, "section[aria-labelledby], #model"].flatMap((kind) =>
    [...document.querySelectorAll(kind)].map((part) => {
      const copy = part.cloneNode(true);
      for (const inside of copy.querySelectorAll(`img, script, style, ${entries}`)) inside.remove();
      const id = part.getAttribute("aria-labelledby") ?? part.id;
      const name = copy.querySelector("h2, h3, summary")?.textContent ?? id;
      return [`#${id}`, id, name, copy.textContent.replace(/\s+/g, " ")];
    }),
  );
}

const MOST = 30; // hits that are listed
function setUpSearch(script) {
  const form = document.getElementById("search");
  const [input, said, hits] = ["query", "found", "hits"].map((id) => document.getElementById(id));
  const up = script.dataset.up ?? "";
  let entries = null;
  let first = null;
  async function show() {
    entries ??= (await loadWords(script)).map(([address, anchor, name, text]) => ({
      id: anchor.replace(/^(eq|claim)-/, "").toLowerCase(),
      text: searchable(text),
      address: address.startsWith("#") ? address : up + address,
      name: (anchor.startsWith("erratum-") ? "Erratum " : "") + name,
    }));
    const sought = input.value.trim();
    const found = search(sought, entries);
    hits.replaceChildren(
      ...found.slice(0, MOST).map(({ address, name }) => {
        const [item, anchor] = [document.createElement("li"), document.createElement("a")];
        anchor.href = address;
        anchor.textContent = name;
        item.append(anchor);
        return item;
      }),
    );
    const more = found.length > MOST ? `, the first ${MOST}:` : "";
    said.textContent = sought && `${found.length} found${more}`;
    first = found[0] ?? null;
  }
  form.hidden = false;
  form.addEventListener("input", show);
  form.addEventListener("submit", async (event) => {
    event.preventDefault();
    await show();
    if (first) location.href = first.address;
  });
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

// Two formulas beside each other stand one below the other where one is too wide; a formula wider than its box is drawn smaller, down to letters that can be read; what is then still too wide scrolls.
const SMALLEST = 14.4; // px, of a formula: its scripts have 0.7 of it
function fitFormulas() {
  for (const pair of document.querySelectorAll("[data-pair]")) pair.className = "pair";
  for (const box of document.querySelectorAll(".wide")) {
    for (const formula of box.querySelectorAll("math[display=block]")) {
      formula.style.fontSize = "";
      const pair = box.closest(".pair");
      if (pair && formula.scrollWidth > 1.1 * box.clientWidth) {
        pair.className = "stack";
        pair.dataset.pair = "";
      }
      const natural = parseFloat(getComputedStyle(formula).fontSize);
      // Letters lean out of their boxes, and smaller ones are wider for their size: a second look.
      for (let pass = 0, share = 1; box.clientWidth && pass < 2; pass++) {
        share *= Math.min(1, (box.clientWidth - 4) / Math.max(formula.scrollWidth, box.scrollWidth - 4));
        if (share < 1) formula.style.fontSize = Math.max(SMALLEST, share * natural) + "px";
      }
    }
    if (box.scrollWidth > box.clientWidth) box.tabIndex = 0; // the keyboard must reach what scrolls
  }
  for (const formula of document.querySelectorAll("math:not([display=block])")) {
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
  fitFormulas();
  addEventListener("resize", fitFormulas);
  for (const fold of document.querySelectorAll("details")) fold.addEventListener("toggle", fitFormulas);
  setUpFigures();
  let opened = [];
  addEventListener("beforeprint", () => {
    opened = [...document.querySelectorAll("details.fold:not([open])")];
    for (const fold of opened) fold.open = true;
  });
  addEventListener("afterprint", () => {
    for (const fold of opened) fold.open = false;
  });
  setUpSearch(script);
}

if (typeof document !== "undefined") setUpPage(document.currentScript);
