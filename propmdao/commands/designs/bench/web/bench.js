"use strict";
(() => {
  const find = (id) => document.getElementById(id);
  const make = (kind, parent, given = {}) => {
    const made = document.createElement(kind);
    for (const [key, value] of Object.entries(given)) {
      if (key in made) made[key] = value; else made.setAttribute(key, value);
    }
    parent.append(made);
    return made;
  };
  // The first numbers that are read: key of the row, name, unit.
  const FIRST = [
    ["thrust", "thrust", "N"], ["shaft_power", "power", "W"], ["rpm", "rotation speed", "rpm"],
    ["figure_of_merit", "figure of merit", ""], ["eta", "efficiency", ""],
    ["at oaspl_dba", "tones", "dBA"], ["at oaspl_broadband_dba", "broadband", "dBA"],
    ["at oaspl_total_dba", "total", "dBA"],
  ];
  const GROUPS = { rotor: "Rotor", operation: "Operating point", microphone: "Microphone" };
  const CHANGES = { chord: "times the described chord", twist: "added to the blade angle",
    camber: "added to camber over chord", thickness: "added to thickness over chord",
    sweep: "added to sweep over tip radius, aft is positive" };

  const sliders = new Map(); // by name: what is known of it, and its elements
  let held = "", number = 0, socket = null, frame = 0, isOver = false;

  // ---- messages out
  const steps = () => Object.fromEntries(
    [...sliders].map(([name, { input, kept }]) => [name, follows(name) ? kept : Number(input.value)]));
  // Of rotation speed and thrust one is held, and the other follows.
  const follows = (name) => ["rpm", "thrust"].includes(name) && name !== held;
  const send = (kind, more = {}) => {
    if (socket?.readyState !== WebSocket.OPEN) return;
    if (kind !== "save") number += 1; // of a design
    socket.send(JSON.stringify({ kind, number, ...more }));
    if (kind !== "save") working("Working");
  };
  const design = () => ({ held, steps: steps() });
  let patience = 0;
  const working = (text) => {
    find("state").textContent = text;
    // Numbers that follow at once do not turn grey between.
    patience ||= setTimeout(() => old(() => true), 400);
  };
  const arrived = () => { clearTimeout(patience); patience = 0; };
  const trouble = (text) => {
    find("trouble").textContent = text;
    find("trouble").hidden = !text;
  };

  // ---- sliders
  // Digits of the step, and up to two more where what is described has them.
  const digits = ({ start, step }) => {
    const least = Math.max(0, Math.ceil(-Math.log10(step) - 1e-9));
    return [least, least + 1].find((n) => Math.abs(start - start.toFixed(n)) < 1e-9) ?? least + 2;
  };
  const written = (slider, value) => {
    const n = Number(value), at = n === 0 ? slider.start : slider.start + n * slider.step;
    const change = slider.start === 0 && slider.name !== "speed" && n > 0 ? "+" : "";
    return `${change}${at.toFixed(digits(slider))}${slider.unit ? " " + slider.unit : ""}`;
  };
  const write = (slider) => {
    const text = written(slider, slider.input.value);
    slider.output.textContent = text;
    slider.output.className = slider.input.value === "0" ? "" : "moved";
    slider.input.setAttribute("aria-valuetext", text);
  };
  const addSlider = (slider, parent) => {
    const row = make("label", parent, { className: "slider" });
    make("span", row, { textContent: slider.label });
    slider.output = make("output", row);
    slider.input = make("input", row, { type: "range", min: -slider.below, max: slider.above, step: 1, value: 0 });
    slider.input.dataset.name = slider.name;
    slider.input.addEventListener("input", () => {
      write(slider);
      // One message for each picture that the screen shows.
      frame ||= requestAnimationFrame(() => { frame = 0; send("drag", design()); });
    });
    slider.input.addEventListener("change", () => {
      cancelAnimationFrame(frame);
      frame = 0;
      send("set", design());
    });
    // Back to what is described.
    row.addEventListener("dblclick", () => {
      slider.input.value = 0;
      write(slider);
      send("set", design());
    });
    sliders.set(slider.name, slider);
    write(slider);
  };
  const build = (message) => {
    const form = find("sliders"), tabs = form.querySelector(".tabs");
    tabs.replaceChildren();
    form.querySelectorAll("fieldset").forEach((set) => set.remove());
    sliders.clear();
    const sets = new Map();
    for (const slider of message.sliders) {
      if (!sets.has(slider.group)) {
        const set = make("fieldset", form, { id: `group-${slider.group}` });
        const changes = CHANGES[slider.group];
        make("legend", set, { textContent: GROUPS[slider.group] ?? `${slider.group}, ${changes}` });
        sets.set(slider.group, set);
        if (changes) {
          const tab = make("button", tabs, { type: "button", textContent: slider.group });
          tab.addEventListener("click", () => choose(slider.group));
          tab.dataset.group = slider.group;
        }
        if (slider.group === "operation") addHold(set, message.sliders);
      }
      addSlider(slider, sets.get(slider.group));
    }
    choose("chord");
  };
  const choose = (group) => {
    for (const tab of document.querySelectorAll(".tabs button")) {
      const isChosen = tab.dataset.group === group;
      tab.setAttribute("aria-pressed", String(isChosen));
      find(`group-${tab.dataset.group}`).hidden = !isChosen;
    }
  };
  const addHold = (set, every) => {
    const row = make("div", set, { className: "hold", role: "radiogroup", "aria-label": "What is held" });
    for (const { name, label } of every.filter((slider) => ["rpm", "thrust"].includes(slider.name))) {
      const choice = make("label", row);
      const radio = make("input", choice, { type: "radio", name: "held", value: name });
      choice.append(` hold ${label}`);
      radio.addEventListener("change", () => send("hold", { held: name }));
    }
  };
  const show = (message) => {
    held = message.held;
    for (const [name, slider] of sliders) {
      slider.kept = message.steps[name];
      slider.input.disabled = follows(name);
      if (follows(name)) continue;
      slider.input.value = slider.kept;
      write(slider);
    }
    for (const radio of document.querySelectorAll("input[name=held]")) radio.checked = radio.value === held;
    find("undo").disabled = !message.can_undo;
    find("redo").disabled = !message.can_redo;
    find("reset").disabled = held === message.held && Object.values(message.steps).every((n) => n === 0);
  };

  // ---- numbers
  const rows = new Map();
  const old = (isOld) => {
    for (const [key, { row, box }] of rows) {
      row.classList.toggle("old", isOld(key));
      box?.classList.toggle("old", isOld(key));
    }
  };
  const tell = (message) => {
    const body = document.querySelector("#table tbody"), first = find("first");
    const every = message.rows.filter(({ key }) => key).map(({ key }) => key);
    // In hover there is a figure of merit, in flight an efficiency.
    if (every.length !== rows.size || every.some((key) => !rows.has(key))) layout(message.rows);
    const has = new Set(message.rows.filter(({ bent }) => bent !== undefined).map(({ key }) => key));
    for (const { key, described, bent, change } of message.rows) {
      if (!has.has(key)) continue;
      const known = rows.get(key);
      [described, bent, change].forEach((text, k) => {
        const cell = known.row.cells[k + 1];
        cell.textContent = text ?? cell.textContent;
        cell.classList.toggle("old", text === undefined);
      });
      if (known.box) {
        const unit = known.box.dataset.unit;
        known.box.replaceChildren(bent + (unit ? ` ${unit} ` : " "));
        if (change) make("span", known.box, { textContent: `(${change})` });
      }
    }
    for (const { key, bent } of message.rows.filter(({ key }) => sliders.has(key) && follows(key))) {
      const { input, output, start, step, unit } = sliders.get(key);
      input.value = Math.round((Number(bent) - start) / step);
      input.setAttribute("aria-valuetext", `${bent} ${unit}`);
      output.textContent = `${bent} ${unit}`;
    }
    const isLatest = message.number >= number;
    arrived();
    old((key) => !has.has(key));
    trouble("");
    const said = find("doubts");
    said.replaceChildren();
    said.hidden = message.doubts.length === 0;
    for (const doubt of message.doubts) make("li", said, { textContent: doubt });
    if (isLatest) find("state").textContent = message.is_complete ? "Up to date" : "More is on its way";
    if (message.is_complete) {
      for (const name of ["described", "bent"]) find(`hear-${name}`).disabled = isOver;
      if (isLatest) hearAnew();
    }
    function layout(labelled) {
      rows.clear();
      body.replaceChildren();
      first.replaceChildren();
      for (const { key, label } of labelled) {
        const row = body.insertRow();
        make("th", row, { className: key ? "words" : "words group", scope: "row", textContent: label });
        for (const name of key ? ["of-a", "of-b", "of-b"] : []) row.insertCell().className = name;
        if (key) { row.dataset.key = key; rows.set(key, { row, box: null }); }
      }
      for (const [key, name, unit] of FIRST) {
        if (!rows.has(key)) continue;
        const box = make("div", first);
        make("dt", box, { textContent: name });
        const value = make("dd", box);
        value.dataset.key = key;
        value.dataset.unit = unit;
        rows.get(key).box = value;
      }
    }
  };

  // ---- figures: the latest ones, drawn with the next picture of the screen
  const waiting = new Map();
  let drawn = 0;
  const draw = () => {
    drawn ||= requestAnimationFrame(() => {
      drawn = 0;
      for (const [canvas, panel] of waiting) drawing.diagram(canvas, panel);
      waiting.clear();
    });
  };
  const kept = new Map(); // what each canvas shows
  const resized = new ResizeObserver((entries) => {
    for (const { target } of entries) if (kept.has(target)) waiting.set(target, kept.get(target));
    draw();
  });
  const put = (parent, panels) => {
    while (parent.children.length < panels.length) {
      const panel = make("div", parent, { className: "panel" });
      make("p", panel, { className: "label" });
      resized.observe(make("canvas", panel, { className: "plot", role: "img" }));
    }
    panels.forEach((panel, k) => {
      const canvas = parent.children[k].querySelector("canvas");
      parent.children[k].querySelector(".label").textContent = panel.label;
      canvas.setAttribute("aria-label", `${panel.label}, of both blades`);
      kept.set(canvas, panel);
      waiting.set(canvas, panel);
    });
    draw();
  };
  const place = document.querySelector("#blade canvas"), inSpace = drawing.space(place);
  const blade = ({ panels: [space, ...shapes] }) => {
    document.querySelector("#blade .label").textContent = space.label;
    inSpace(space);
    place.dataset.drawn = space.label;
    put(find("shapes"), shapes);
  };

  // ---- sounds, repeated without a click; A and B as loud to each other as they are
  const FADE = 0.01; // s, so that going over from one to the other is no click
  const START = 3000; // ms in which an audio output starts, where there is one
  const nothing = (time) => new Promise((done) => setTimeout(done, time, false));
  let context = null, playing = "", source = null, asked = 0;
  const fetched = new Map();
  const load = async (name) => {
    const answer = await fetch(`sound/${name}`);
    if (!answer.ok) throw new Error(await answer.text());
    const scale = Number(answer.headers.get("X-Full-Scale"));
    return { scale, buffer: await context.decodeAudioData(await answer.arrayBuffer()) };
  };
  const hear = async (name) => {
    playing = name;
    for (const each of ["described", "bent"]) {
      find(`hear-${each}`).setAttribute("aria-pressed", String(each === name));
    }
    asked += 1;
    const turn = asked;
    if (!name) { silence(); return; }
    try {
      context ??= new AudioContext();
      // Where there is no audio output, this may never be answered.
      const begun = Promise.race([context.resume().then(() => true), nothing(START)]);
      for (const each of ["described", "bent"]) fetched.set(each, await load(each));
      if (turn !== asked) return;
      const { scale, buffer } = fetched.get(name);
      const loudest = Math.max(...[...fetched.values()].map((sound) => sound.scale));
      silence();
      const { gain } = source = { node: context.createBufferSource(), gain: context.createGain() };
      gain.gain.setValueAtTime(0, context.currentTime);
      gain.gain.setTargetAtTime(0.9 * scale / loudest, context.currentTime, FADE);
      source.node.buffer = buffer;
      source.node.loop = true;
      source.node.connect(gain).connect(context.destination);
      source.node.start();
      find(`hear-${name}`).dataset.heard = String(scale);
      if (!await begun && turn === asked) throw new Error("the browser has no audio output");
    } catch (error) {
      trouble(`No sound: ${error.message}`);
      hear("");
    }
  };
  const silence = () => {
    if (!source) return;
    source.gain.gain.setTargetAtTime(0, context.currentTime, FADE);
    source.node.stop(context.currentTime + 8 * FADE);
    source = null;
  };
  const hearAnew = () => { if (playing) hear(playing); };
  for (const name of ["described", "bent"]) {
    find(`hear-${name}`).addEventListener("click", () => hear(playing === name ? "" : name));
  }

  // ---- buttons and keys
  for (const kind of ["undo", "redo", "reset", "save"]) find(kind).addEventListener("click", () => send(kind));
  document.addEventListener("keydown", (event) => {
    if (!(event.ctrlKey || event.metaKey) || event.key.toLowerCase() !== "z") return;
    event.preventDefault();
    send(event.shiftKey ? "redo" : "undo");
  });
  find("sliders").addEventListener("submit", (event) => event.preventDefault());

  // ---- messages in
  const kinds = {
    start: (message) => {
      number = message.number;
      find("name").textContent = message.name;
      document.title = `${message.name} - propmdao bench`;
      build(message);
      show(message);
      find("save").hidden = message.file === null;
      if (message.file) find("save").title = message.file;
      find("state").textContent = "Working";
    },
    design: show,
    numbers: tell,
    blade,
    spectra: ({ panels }) => put(find("spectra"), panels),
    working: (message) => { if (message.number >= number) working(message.text); },
    trouble: (message) => {
      if (message.number < number) return;
      trouble(message.text);
      arrived();
      find("state").textContent = "Grey numbers are of the blades before, which could be analysed";
      old(() => true);
    },
    saved: ({ text }) => { find("state").textContent = text; },
  };
  socket = new WebSocket(new URL("messages", location.href.replace(/^http/, "ws")));
  socket.addEventListener("message", ({ data }) => {
    const message = JSON.parse(data);
    kinds[message.kind](message);
  });
  socket.addEventListener("close", ({ code }) => {
    isOver = true;
    hear("");
    find("state").textContent = "";
    trouble(code === 4000 ? "The bench is open in another window; reload to go on here."
      : "The bench has ended; start it again on the command line.");
    for (const control of document.querySelectorAll("input, button")) control.disabled = true;
    find("download").removeAttribute("href");
  });
})();
