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
    made.createCaption().textContent = plot.previousElementSibling?.textContent ?? "";
    const head = made.createTHead().insertRow(), body = made.createTBody();
    const named = layout.meta?.columns ?? ["", ""];
    ["", ...named].forEach((text) => cell(head, "th", text));
    for (const trace of data) {
      for (const values of trace.meta?.hidden ? [] : points(trace)) {
        const row = body.insertRow();
        cell(row, "th", plain(trace.name));
        values.forEach((value) => cell(row, "td", value));
      }
    }
    return made;
  };

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
  const config = {
    displaylogo: false, responsive: true, scrollZoom: false, displayModeBar: touch ? false : "hover",
    modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d", "zoomIn2d", "zoomOut2d", "sendDataToCloud"],
  };
  const eyes = {
    "all around": { eye: { x: 0.75, y: -1.1, z: 0.9 }, up: { x: 0, y: 0, z: 1 } },
    "from ahead": { eye: { x: 0, y: 0, z: 1.6 }, up: { x: 0, y: 1, z: 0 } },
    "from the side": { eye: { x: 0, y: -1.6, z: 0 }, up: { x: 0, y: 0, z: 1 } },
    "from the tip": { eye: { x: 1.6, y: 0, z: 0 }, up: { x: 0, y: 0, z: 1 } },
  };
  const draw = async () => {
    for (const plot of plots.filter((plot) => visible(plot) && !plot.dataset.drawn)) {
      plot.dataset.drawn = "true";
      const { data, layout } = figures[number(plot)];
      // A finger that moves over a diagram moves the page.
      const dragged = touch && !layout.scene ? { ...layout, dragmode: false } : layout;
      await Plotly.newPlot(plot, data, dragged, config);
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
      const eye = eyes[event.target.dataset.view];
      if (eye) Plotly.relayout(plot, { "scene.camera": eye });
    });
  }
  await draw();
  // On paper the diagrams are as wide as the page; the size on the screen comes back after it.
  const fit = () => plots.filter(visible).forEach((plot) => {
    Plotly.relayout(plot, { width: plot.clientWidth, height: plot.clientHeight });
  });
  matchMedia("print").addEventListener("change", fit);
  document.documentElement.dataset.drawn = "true";
})();
