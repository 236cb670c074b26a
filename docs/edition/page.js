"use strict";
// The files of Python are scripts beside this page, base64 of gzip: a page from file:// may not fetch, but it may load scripts.
const held = {}, status = document.getElementById("status");
function embedded(name, text) { held[name] = text; }

function script(address) {
  return new Promise((resolve, reject) => {
    const element = document.createElement("script");
    element.src = address;
    element.onload = resolve;
    element.onerror = () => reject(new Error(`${address} is not beside this page: keep the folder whole`));
    document.head.append(element);
  });
}

async function unpacked(text) {
  const packed = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
}

let files, worker, ready, count = 0;
const waiting = new Map();

// A worker computes, so that the page stays alive and what takes too long can be stopped.
function begin() {
  const source = URL.createObjectURL(new Blob([WORKER], { type: "text/javascript" }));
  worker = new Worker(source);
  ready = new Promise((resolve) => {
    worker.onmessage = ({ data }) => {
      if (data.ready) { resolve(); return; }
      if (data.failed) { status.textContent = data.failed; return; }
      waiting.get(data.number)?.(data.html);
      waiting.delete(data.number);
    };
  });
  worker.onerror = (event) => { status.textContent = `Python cannot begin: ${event.message ?? "this browser refuses a worker"}`; };
  worker.postMessage({ files });
  return ready;
}

async function ask(kind, fields) {
  await ready;
  const number = count += 1;
  const answer = new Promise((resolve) => waiting.set(number, resolve));
  worker.postMessage({ number, kind, fields });
  return answer;
}

function prepare(form) {
  const select = form.querySelector("select"), about = form.querySelector(".about");
  const [go, stop] = form.querySelectorAll("button"), answer = form.querySelector(".answer");
  const examples = EXAMPLES[form.id], groups = new Map();
  examples.forEach((example, place) => {
    const option = new Option(example.title, place);
    if (!example.group) { select.append(option); return; }
    if (!groups.has(example.group)) {
      groups.set(example.group, Object.assign(document.createElement("optgroup"), { label: example.group }));
      select.append(groups.get(example.group));
    }
    groups.get(example.group).append(option);
  });
  const take = () => {
    const example = examples[select.value];
    for (const field of form.querySelectorAll("[name]")) field.value = example[field.name] ?? "";
    about.textContent = example.about ?? "";
    answer.replaceChildren();
  };
  select.onchange = take;
  take();
  stop.onclick = () => {
    worker.terminate();
    for (const resolve of waiting.values()) resolve("<p class=\"refusal\">stopped</p>");
    waiting.clear();
    begin();
  };
  form.onsubmit = async (event) => {
    event.preventDefault();
    if (go.disabled) return;
    go.disabled = true;
    stop.hidden = false;
    answer.textContent = "derives …";
    answer.innerHTML = await ask(form.id, Object.fromEntries(new FormData(form)));
    go.disabled = false;
    stop.hidden = true;
  };
  form.addEventListener("keydown", (event) => {
    if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) form.requestSubmit();
  });
  return go;
}

async function start() {
  const buttons = [...document.forms].map(prepare);
  const clock = performance.now();
  files = {};
  for (const [place, name] of FILES.entries()) {
    status.textContent = `Loads Python, ${place + 1} of ${FILES.length} …`;
    await script(`data/${name}.js`);
    files[name] = await unpacked(held[name]);
    delete held[name];
  }
  status.textContent = "Python begins …";
  await begin();
  status.textContent = `Ready after ${Math.round((performance.now() - clock) / 1000)} s.`;
  for (const button of buttons) button.disabled = false;
}

start().catch((error) => { status.textContent = `It cannot begin: ${error.message}`; });
