// The motion in a notebook's cell, its time and whether it plays shared with Python, ten times a second while it plays.

const EVERY = 100; // ms

export default {
  render({ model, el }) {
    let sent = 0, shared = model.get("time"), ready = false;
    el.classList.add("motion");
    el.innerHTML = model.get("parts");
    const shown = showMotion(el, model.get("motion"), ({ time, playing }) => {
      if (!ready || (playing && playing === model.get("playing") && performance.now() - sent < EVERY)) return;
      sent = performance.now();
      shared = time;
      model.set("time", time);
      model.set("playing", playing);
      model.save_changes();
    });
    const seek = () => model.get("time") !== shared && shown.seek(model.get("time"));
    const play = () => shown.play(model.get("playing"));
    shown.seek(shared);
    ready = true;
    play();
    model.on("change:time", seek);
    model.on("change:playing", play);
    return () => {
      model.off("change:time", seek);
      model.off("change:playing", play);
      shown.play(false);
    };
  },
};
