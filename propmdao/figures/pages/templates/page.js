"use strict";
(async () => {
  const content = (id) => document.getElementById(id).textContent;
  const figures = JSON.parse(content("figures"));
  const plots = [...document.querySelectorAll(".plot")];
  const number = (plot) => Number(plot.dataset.figure);
  const visible = (plot) => !plot.closest("[hidden]");

  // Choices and tables of numbers need no Plotly.
  for (const select of document.querySelectorAll(".choice select")) {
    select.addEventListener("change", () => {
      for (const panels of select.closest("figure").querySelectorAll(".panels")) {
        panels.hidden = panels.dataset.choice !== select.value;
      }
      draw();
      details(select.closest("figure"));
    });
  }

  const cell = (row, kind, text) => {
    const made = document.createElement(kind);
    made.textContent = typeof text === "number" ? String(Number(text.toPrecision(6))) : (text ?? "");
    row.append(made);
  };
  // Plotly's text knows a few tags and entities; names have none but entities.
  const plain = (text) => new DOMParser().parseFromString(text ?? "", "text/html").body.textContent;

  // A row for each point of a trace; a map has one for each of its cells.
  const points = (trace) => {
    if (trace.z && trace.type !== "surface") {
      return trace.z.flatMap((row, j) => row.map((z, i) => [trace.x[i], trace.y[j], z]));
    }
    const [a, b] = trace.theta ? [trace.theta, trace.r] : [trace.x, trace.y];
    return a.map((value, i) => [value, b[i]]);
  };

  const table = (plot) => {
    const { data, layout } = figures[number(plot)];
    const made = document.createElement("table");
    made.createCaption().textContent = plot.closest(".panel").querySelector(".label").textContent;
    const head = made.createTHead().insertRow(), body = made.createTBody();
    const named = layout.meta?.columns ?? ["", ""];
    ["", ...named].forEach((text) => cell(head, "th", text));
    for (const trace of data) {
      for (const values of trace.meta?.hidden ? [] : points(trace)) {
        if (values.includes(null)) continue;
        const row = body.insertRow();
        cell(row, "th", plain(trace.name));
        values.forEach((value) => cell(row, "td", value));
      }
    }
    return made;
  };

  // Names of the lines, as buttons that hide and show them.
  const legend = (plot) => {
    const named = figures[number(plot)].data.filter((trace) => trace.name && !trace.meta?.hidden);
    if (named.length < 2 || plot.classList.contains("space")) return;
    const list = document.createElement("ul");
    list.className = "legend";
    for (const trace of named) {
      const button = list.appendChild(document.createElement("li"))
        .appendChild(document.createElement("button"));
      button.type = "button";
      button.setAttribute("aria-pressed", "true");
      button.append(sample(trace), plain(trace.name));
      button.addEventListener("click", () => {
        const shown = button.getAttribute("aria-pressed") !== "true";
        button.setAttribute("aria-pressed", String(shown));
        const same = plot.data.flatMap((other, i) =>
          other.name === trace.name || other.legendgroup === trace.name ? [i] : []);
        Plotly.restyle(plot, { visible: shown }, same);
      });
    }
    plot.before(list);
  };
  const sample = (trace) => {
    const make = (name, given, parent) => {
      const made = parent.appendChild(document.createElementNS("http://www.w3.org/2000/svg", name));
      for (const [key, value] of Object.entries(given)) made.setAttribute(key, value);
      return made;
    };
    const drawing = make("svg", { width: 34, height: 12, "aria-hidden": "true" }, document.createElement("span"));
    const dashes = { dash: "8 4", dot: "2.5 3.5", dashdot: "8 3 2.5 3" }[trace.line.dash] ?? "none";
    if (trace.mode !== "markers") {
      make("line", { x1: 1, x2: 33, y1: 6, y2: 6, stroke: trace.line.color,
        "stroke-width": trace.line.width, "stroke-dasharray": dashes }, drawing);
    }
    const signs = { circle: "M17 2a4 4 0 1 0 .01 0z", square: "M13 2h8v8h-8z", diamond: "M17 1l5 5-5 5-5-5z",
      "triangle-up": "M17 1l5 9h-10z", "triangle-down": "M17 11l5-9h-10z" };
    if (trace.marker) make("path", { d: signs[trace.marker.symbol] ?? signs.circle, fill: trace.line.color }, drawing);
    return drawing;
  };
  plots.forEach(legend);

  const details = (figure) => {
    const box = figure.querySelector("details");
    const shown = [...figure.querySelectorAll(".plot:not(.space)")].filter(visible);
    box.hidden = shown.length === 0;
    if (box.open) box.querySelector("div").replaceChildren(...shown.map(table));
  };
  for (const figure of document.querySelectorAll("figure")) {
    figure.querySelector("details").addEventListener("toggle", () => details(figure));
    details(figure);
  }

  const trouble = (text) => {
    const line = document.getElementById("trouble");
    line.textContent = text;
    line.hidden = false;
  };
  if (typeof DecompressionStream === "undefined") {
    trouble("The figures need a newer browser, of 2023 or later; tables and sounds are complete.");
    return;
  }
  const bytes = Uint8Array.from(atob(content("plotly")), (sign) => sign.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  const script = document.createElement("script");
  script.textContent = await new Response(stream).text();
  document.head.append(script);
  if (typeof Plotly === "undefined") {
    trouble("The figures could not be drawn; tables and sounds are complete.");
    return;
  }

  const touch = matchMedia("(pointer: coarse)").matches;
  const config = (layout) => ({
    displaylogo: false, responsive: true, scrollZoom: false, displayModeBar: touch ? false : "hover",
    modeBarButtons: [["toImage", ...(layout.scene ? ["resetCameraDefault3d"] : layout.polar ? [] : ["resetScale2d"])]],
  });
  const views = {
    "all around": { eye: { x: 0.6, y: -1.1, z: 0.9 }, up: { x: 0, y: 0, z: 1 }, across: "xyz" },
    "from ahead": { eye: { x: 0, y: 0, z: 1.5 }, up: { x: 0, y: 1, z: 0 }, across: "xy" },
    "from the side": { eye: { x: 0, y: -1.5, z: 0 }, up: { x: 0, y: 0, z: 1 }, across: "xz" },
    "from the tip": { eye: { x: 1.5, y: 0, z: 0 }, up: { x: 0, y: 0, z: 1 }, across: "yz" },
  };
  // A body as large as its place allows; without perspective its size is that of the axes.
  const fill = (plot, scene) => {
    const size = Math.min(Math.max(1, plot.clientWidth / plot.clientHeight), 2);
    for (const axis of "xyz") scene.aspectratio[axis] *= size;
    return { ...scene.aspectratio };
  };
  const draw = async () => {
    for (const plot of plots.filter((plot) => visible(plot) && !plot.dataset.drawn)) {
      plot.dataset.drawn = "true";
      const { data, layout } = figures[number(plot)];
      // A finger that moves over a diagram moves the page.
      if (touch && !layout.scene) layout.dragmode = false;
      if (layout.scene) figures[number(plot)].filled = fill(plot, layout.scene);
      await Plotly.newPlot(plot, data, layout, config(layout));
      // On paper a diagram is scaled to its place.
      const scalable = () => plot.querySelectorAll("svg.main-svg").forEach((svg) => {
        svg.setAttribute("viewBox", `0 0 ${svg.getAttribute("width")} ${svg.getAttribute("height")}`);
      });
      plot.on("plotly_afterplot", scalable);
      scalable();
      await new Promise((resolve) => setTimeout(resolve));
    }
    for (const plot of plots.filter((plot) => visible(plot) && plot.dataset.drawn)) {
      Plotly.Plots.resize(plot);
    }
  };
  for (const row of document.querySelectorAll(".views")) {
    row.hidden = false;
    const plot = row.parentElement.querySelector(".plot");
    row.addEventListener("click", (event) => {
      const view = views[event.target.dataset.view];
      if (!view) return;
      // What is across the line of sight is as large as the whole is from elsewhere.
      const sizes = Object.entries(figures[number(plot)].filled);
      const widest = (axes) => Math.max(...sizes.filter(([axis]) => axes.includes(axis)).map(([, size]) => size));
      const larger = widest("xyz") / widest(view.across);
      // An eye so far away that no part is behind it.
      const eye = Object.fromEntries(Object.entries(view.eye).map(([axis, x]) => [axis, x * larger]));
      Plotly.relayout(plot, {
        "scene.camera.eye": eye, "scene.camera.up": view.up,
        "scene.aspectratio": Object.fromEntries(sizes.map(([axis, size]) => [axis, size * larger])),
      });
    });
  }
  await draw();
  document.documentElement.dataset.drawn = "true";
})();
