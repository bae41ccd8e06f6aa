"use strict";
// Figures on canvases, from what Plotly would be given: it takes too long while somebody drags.
const drawing = (() => {
  const INK = "#1a1a1a", SOFT = "#555", GRID = "#e2e2e2", FONT = "12px system-ui, sans-serif";
  const DASHES = { solid: [], dash: [8, 4], dot: [2.5, 3.5], dashdot: [8, 3, 2.5, 3] };

  // A canvas as sharp as the screen, cleared; sizes are those of CSS.
  const begin = (canvas) => {
    const ratio = window.devicePixelRatio || 1, { clientWidth: width, clientHeight: height } = canvas;
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
    }
    const pen = canvas.getContext("2d");
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    pen.font = FONT;
    pen.lineJoin = "round";
    return { pen, width, height };
  };
  // Text of Plotly has entities for signs; nothing of it is markup here.
  const plain = (text) => text.replaceAll("&lt;", "<").replaceAll("&gt;", ">").replaceAll("&amp;", "&");

  // ---- diagrams of two axes
  const niceStep = (span, most) => {
    const least = span / most, power = 10 ** Math.floor(Math.log10(least));
    return [1, 2, 5, 10].map((k) => k * power).find((step) => step >= least * (1 - 1e-9));
  };
  const ticksOf = (axis, [low, high], most) => {
    if (axis.tickvals) {
      const place = axis.type === "log" ? Math.log10 : Number;
      return axis.tickvals.map((value, k) => [place(value), axis.ticktext[k]]);
    }
    const step = niceStep(high - low, most), digits = Math.max(0, Math.ceil(-Math.log10(step) - 1e-9));
    const first = Math.ceil(low / step - 1e-9);
    return Array.from({ length: Math.floor(high / step + 1e-9) - first + 1 }, (_, k) => {
      const value = (first + k) * step;
      return [value, (Math.abs(value) < 1e-12 ? 0 : value).toFixed(digits).replace("-", "\u2212")];
    });
  };
  const rangeOf = (axis, values, margin) => {
    if (axis.range) return axis.range;
    let low = Infinity, high = -Infinity;
    for (const value of values) { low = Math.min(low, value); high = Math.max(high, value); }
    if (!(high >= low)) return [0, 1];
    if (axis.rangemode === "tozero") { low = Math.min(low, 0); high = Math.max(high, 0); }
    const room = (high - low || Math.abs(high) || 1) * margin;
    return [low === 0 ? 0 : low - room, high + room];
  };
  const diagram = (canvas, { data, layout }) => {
    const { pen, width, height } = begin(canvas);
    const box = { left: 46, right: width - 12, top: 8, bottom: height - 38 };
    const { xaxis, yaxis } = layout, isLog = xaxis.type === "log";
    const points = data.map(({ x, y }) => x.map((value, k) => [value === null ? NaN
      : isLog ? Math.log10(value) : value, y[k] ?? NaN]));
    const known = points.flat().filter(([x, y]) => Number.isFinite(x) && Number.isFinite(y));
    let across = rangeOf(xaxis, known.map(([x]) => x), xaxis.rangemode ? 0.04 : 0), up = rangeOf(yaxis, known.map(([, y]) => y), 0.05);
    if (yaxis.scaleanchor) { // one scale along both axes
      const scale = Math.max((across[1] - across[0]) / (box.right - box.left), (up[1] - up[0]) / (box.bottom - box.top));
      const around = ([low, high], size) => {
        const middle = 0.5 * (low + high), half = 0.5 * scale * size;
        return [middle - half, middle + half];
      };
      across = around(across, box.right - box.left);
      up = around(up, box.bottom - box.top);
    }
    const px = (x) => box.left + (x - across[0]) / (across[1] - across[0]) * (box.right - box.left);
    const py = (y) => box.bottom - (y - up[0]) / (up[1] - up[0]) * (box.bottom - box.top);
    const stroke = (color, wide, dash, path) => {
      pen.strokeStyle = color;
      pen.lineWidth = wide;
      pen.setLineDash(dash);
      pen.beginPath();
      path();
      pen.stroke();
    };
    pen.fillStyle = INK;
    pen.textBaseline = "top";
    pen.textAlign = "center";
    for (const [x, text] of ticksOf(xaxis, across, Math.max(2, width / 90))) {
      stroke(GRID, 1, [], () => { pen.moveTo(px(x), box.top); pen.lineTo(px(x), box.bottom + 4); });
      pen.fillText(text, px(x), box.bottom + 6);
    }
    pen.fillText(plain(xaxis.title.text), 0.5 * (box.left + box.right), height - 15);
    pen.textAlign = "right";
    pen.textBaseline = "middle";
    for (const [y, text] of ticksOf(yaxis, up, Math.max(2, height / 45))) {
      stroke(GRID, 1, [], () => { pen.moveTo(box.left - 4, py(y)); pen.lineTo(box.right, py(y)); });
      pen.fillText(text, box.left - 7, py(y));
    }
    stroke("#777", 1, [], () => { pen.moveTo(box.left, box.top); pen.lineTo(box.left, box.bottom); pen.lineTo(box.right, box.bottom); });
    pen.save();
    pen.beginPath();
    pen.rect(box.left, box.top, box.right - box.left, box.bottom - box.top);
    pen.clip();
    points.forEach((line, k) => {
      const { line: { color, width: wide, dash }, mode, marker } = data[k];
      if (mode !== "markers") {
        stroke(color, wide, DASHES[dash] ?? [], () => {
          let isBroken = true;
          for (const [x, y] of line) {
            if (!(Number.isFinite(x) && Number.isFinite(y))) { isBroken = true; continue; }
            if (isBroken) pen.moveTo(px(x), py(y)); else pen.lineTo(px(x), py(y));
            isBroken = false;
          }
        });
      }
      if (!marker) return;
      pen.fillStyle = color;
      const half = 4;
      for (const [x, y] of line) {
        pen.beginPath(); // dots of A, squares of B
        if (marker.symbol === "circle") pen.arc(px(x), py(y), half, 0, 2 * Math.PI);
        else pen.rect(px(x) - half, py(y) - half, 2 * half, 2 * half);
        pen.fill();
      }
    });
    pen.restore();
  };

  // ---- bodies in space, seen from afar; the farthest faces are painted first
  const HOME = { azimuth: -1.07, height: 0.62 };
  const space = (canvas) => {
    let view = { ...HOME }, body = null, frame = 0, before = null;
    const paint = () => {
      frame = 0;
      if (!body) return;
      const { pen, width, height } = begin(canvas);
      const [ca, sa, ch, sh] = [Math.cos(view.azimuth), Math.sin(view.azimuth), Math.cos(view.height), Math.sin(view.height)];
      // To the right, up, and toward the eye.
      const turned = (x, y, z) => {
        const right = -sa * x + ca * y, ahead = ca * x + sa * y;
        return [right, ch * z - sh * ahead, sh * z + ch * ahead];
      };
      const scale = 0.46 * Math.min(width, height / Math.max(Math.abs(sh), 0.35)) / body.radius;
      const place = ([right, up]) => [0.5 * width + scale * right, 0.5 * height - scale * up];
      const faces = [];
      for (const { x, y, z, color } of body.blades) {
        const at = x.map((row, i) => row.map((value, j) => turned(value, y[i][j], z[i][j])));
        for (let i = 1; i < at.length; i++) {
          for (let j = 1; j < at[i].length; j++) {
            const corners = [at[i - 1][j - 1], at[i - 1][j], at[i][j], at[i][j - 1]];
            const [a, b, c, d] = corners, u = c.map((v, k) => v - a[k]), w = d.map((v, k) => v - b[k]);
            const n = [u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]];
            const size = Math.hypot(...n) || 1;
            const light = 0.45 + 0.55 * Math.abs(0.25 * n[0] + 0.5 * n[1] + 0.83 * n[2]) / size;
            faces.push({ corners, depth: a[2] + b[2] + c[2] + d[2], fill: shade(color, light) });
          }
        }
      }
      faces.sort((one, other) => one.depth - other.depth);
      for (const { corners, fill } of faces) {
        pen.fillStyle = pen.strokeStyle = fill;
        pen.lineWidth = 0.7; // closes the seams
        pen.beginPath();
        corners.forEach((corner, k) => { const [px, py] = place(corner); if (k) pen.lineTo(px, py); else pen.moveTo(px, py); });
        pen.closePath();
        pen.fill();
        pen.stroke();
      }
      // The shaft, toward thrust, and the circle of the tips.
      pen.strokeStyle = SOFT;
      pen.lineWidth = 1;
      pen.setLineDash([3, 4]);
      pen.beginPath();
      for (let k = 0; k <= 72; k++) {
        const [px, py] = place(turned(body.radius * Math.cos(k * Math.PI / 36), body.radius * Math.sin(k * Math.PI / 36), 0));
        if (k) pen.lineTo(px, py); else pen.moveTo(px, py);
      }
      pen.stroke();
      pen.setLineDash([]);
      const [x0, y0] = place(turned(0, 0, 0)), [x1, y1] = place(turned(0, 0, 0.35 * body.radius));
      pen.beginPath();
      pen.moveTo(x0, y0);
      pen.lineTo(x1, y1);
      pen.stroke();
      pen.fillStyle = INK;
      pen.textAlign = "left";
      pen.textBaseline = "bottom";
      pen.fillText("thrust", x1 + 5, y1 + 5);
    };
    const repaint = () => { frame ||= requestAnimationFrame(paint); };
    const turn = (azimuth, height) => {
      view.azimuth += azimuth;
      view.height = Math.min(Math.max(view.height + height, -Math.PI / 2), Math.PI / 2);
      repaint();
    };
    canvas.addEventListener("pointerdown", (event) => { before = [event.clientX, event.clientY]; canvas.setPointerCapture(event.pointerId); });
    canvas.addEventListener("pointermove", (event) => {
      if (!before) return;
      turn(-0.01 * (event.clientX - before[0]), 0.01 * (event.clientY - before[1]));
      before = [event.clientX, event.clientY];
    });
    for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, () => { before = null; });
    canvas.addEventListener("dblclick", () => { view = { ...HOME }; repaint(); });
    canvas.addEventListener("keydown", (event) => {
      const by = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] }[event.key];
      if (!by) return;
      event.preventDefault();
      turn(...by);
    });
    new ResizeObserver(repaint).observe(canvas);
    return ({ data }) => {
      const blades = data.map(({ x, y, z, colorscale }) => ({ x, y, z, color: colorscale[0][1] }));
      let radius = 0;
      for (const { x, y } of blades) {
        x.forEach((row, i) => row.forEach((value, j) => { radius = Math.max(radius, Math.hypot(value, y[i][j])); }));
      }
      body = { blades, radius };
      repaint();
    };
  };
  const shade = (color, light) => {
    const parts = [1, 3, 5].map((k) => Math.round(light * parseInt(color.slice(k, k + 2), 16)));
    return `rgb(${parts.join(",")})`;
  };

  return { diagram, space };
})();
