// Python in a worker. What Pyodide would fetch is handed over in `files`. It wants a worker that is a module, which browsers
// refuse from disk; this one only lacks what tells the two apart.
self.importScripts = undefined;
let answer;
const types = { wasm: "application/wasm", mjs: "text/javascript", zip: "application/zip" };

async function begin(files) {
  const blob = (name) => new Blob([files[name]], { type: types[name.split(".").pop()] });
  self.fetch = async (address) => {
    const name = String(address).split("/").pop();
    if (!(name in files)) throw new Error(`${name} is not in the folder`);
    return new Response(blob(name));
  };
  const load = (name) => import(URL.createObjectURL(blob(name)));
  const { loadPyodide } = await load("pyodide.mjs");
  const python = await loadPyodide({
    indexURL: "http://embedded/",
    createPyodideModule: (await load("pyodide.asm.mjs")).default,
    lockFileContents: LOCK,
  });
  python.FS.mkdirTree("/packages");
  python.unpackArchive(files["packages.zip"], "zip", { extractDir: "/packages" });
  answer = python.runPython("import sys; sys.path.insert(0, '/packages'); import answers; answers.answer");
  postMessage({ ready: true });
}

onmessage = async ({ data }) => {
  try {
    if (data.files) { await begin(data.files); return; }
    postMessage({ number: data.number, html: answer.callKwargs(data.kind, data.fields) });
  } catch (error) {
    const text = String(error.message ?? error).trim().split("\n").pop();
    if (data.files) postMessage({ failed: `Python cannot begin: ${text}` });
    else {
      const shown = text.replace(/[&<>]/g, (c) => `&#${c.charCodeAt(0)};`);
      postMessage({ number: data.number, html: `<p class="refusal">${shown}</p>` });
    }
  }
};
