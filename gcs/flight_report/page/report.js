"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const root = document.documentElement;
  const button = document.getElementById("theme");
  const dark = window.matchMedia("(prefers-color-scheme: dark)");
  const PRINT_WIDTH = 660, HEIGHT = 190;
  const TIME_STEPS = [0.1, 0.2, 0.5, 1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 14400, 43200, 86400];
  const TURN_STEPS = [1, 2, 5, 10, 15, 30, 45, 90, 180];
  let chosen = "";
  let plots = [];

  function ink(name) {
    return getComputedStyle(root).getPropertyValue(name).trim();
  }

  function show(theme) {
    root.dataset.theme = theme;
    button.textContent = theme === "dark" ? "Light" : "Dark";
    plots.forEach((plot) => plot.redraw(false, true));
  }

  function theme() {
    return chosen || (dark.matches ? "dark" : "light");
  }

  button.hidden = false;
  button.addEventListener("click", () => {
    chosen = theme() === "dark" ? "light" : "dark";
    show(chosen);
  });
  dark.addEventListener("change", () => show(theme()));
  show(theme());

  function clock(seconds) {
    const tenths = Math.round(seconds * 10), minutes = Math.floor(tenths / 600);
    const rest = ((tenths % 600) / 10).toFixed(1).padStart(4, "0");
    if (minutes < 60) return minutes + ":" + rest;
    return Math.floor(minutes / 60) + ":" + String(minutes % 60).padStart(2, "0") + ":" + rest.slice(0, 2);
  }

  function tick(seconds) {
    return clock(seconds).replace(/\.0$/, "");
  }

  function compass(degrees) {
    return ((degrees % 360) + 360) % 360;
  }

  const LEVELS = { note: "--note", warning: "--warn", critical: "--bad" };

  function line(u, from, to, color, dash) {
    const ctx = u.ctx;
    ctx.save();
    ctx.strokeStyle = color;
    ctx.lineWidth = devicePixelRatio;
    ctx.setLineDash(dash.map((length) => length * devicePixelRatio));
    ctx.beginPath();
    ctx.moveTo(...from);
    ctx.lineTo(...to);
    ctx.stroke();
    ctx.restore();
  }

  function drawMarks(chart) {
    return (u) => {
      const { left, top, width, height } = u.bbox;
      for (const mark of chart.marks) {
        const x = u.valToPos(mark.t_s, "x", true);
        if (x >= left && x <= left + width) line(u, [x, top], [x, top + height], ink(LEVELS[mark.level]), [2, 3]);
      }
    };
  }

  function drawLimits(chart) {
    return (u) => {
      const { left, top, width, height } = u.bbox;
      for (const limit of chart.limits) {
        const scale = limit.axis ? "right" : "y";
        if (!u.scales[scale] || u.scales[scale].min == null) continue;
        const y = u.valToPos(limit.value, scale, true);
        if (y >= top && y <= top + height) line(u, [left, y], [left + width, y], ink(LEVELS[limit.level]), [6, 4]);
      }
    };
  }

  function range(low, high, span) {
    return (u, min, max) => {
      if (min == null) return [low ?? 0, high ?? 1];
      const missing = Math.max(0, span - (max - min)) / 2;
      min -= missing;
      max += missing;
      const pad = (max - min || Math.abs(max) || 1) * 0.08;
      return [low ?? min - pad, Math.max(max + pad, high ?? max + pad)];
    };
  }

  // Wide enough for the longest number.
  function roomy(u, values) {
    return Math.max(44, 14 + 7 * Math.max(0, ...(values || []).map((each) => String(each ?? "").length)));
  }

  function columns(chart) {
    return [chart.x, ...chart.lines.map((each) => each.values)];
  }

  function options(chart, width) {
    const axis = {
      stroke: () => ink("--soft"), grid: { stroke: () => ink("--line"), width: 1 },
      ticks: { show: false }, font: "12px system-ui, sans-serif",
    };
    const right = chart.lines.some((each) => each.axis);
    const axes = [
      { ...axis, values: (u, at) => at.map(tick), incrs: TIME_STEPS, size: 28, space: 70 },
      { ...axis, size: roomy, values: chart.circle ? (u, at) => at.map(compass) : undefined, incrs: chart.circle ? TURN_STEPS : undefined },
    ];
    if (right) axes.push({ ...axis, scale: "right", side: 1, size: 44, grid: { show: false } });
    const scales = {
      x: { time: false, range: (u, min, max) => (min === max ? [min - 1, max + 1] : [min, max]) },
      y: { range: range(chart.low, null, chart.circle ? 40 : 0) },
    };
    if (right) scales.right = { range: range(0, chart.right_to, 0) };
    const series = chart.lines.map((each, number) => ({
      label: each.unit ? each.label + ", " + each.unit : each.label,
      scale: each.axis ? "right" : "y",
      stroke: () => ink("--c" + (number % 4 + 1)),
      width: 1.5,
      // There are four colours: lines after the fourth are dotted.
      dash: each.dashed ? [6, 4] : number > 3 ? [2, 3] : undefined,
      paths: each.dots ? () => null : each.steps ? uPlot.paths.stepped({ align: 1 }) : undefined,
      points: each.dots ? { show: true, size: 3 } : { show: false },
      value: (u, value) => (value == null ? "–" : String(Math.round((chart.circle ? compass(value) : value) * 100) / 100)),
    }));
    return {
      // Without a second scale its room is left free, so that all plots have one time axis.
      width, height: HEIGHT, axes, scales, padding: [8, right ? 0 : width < 500 ? 12 : 44, 0, 0],
      series: [{ label: "at", value: (u, value) => (value == null ? "–" : clock(value)) }, ...series],
      cursor: { sync: { key: "flight" }, drag: { x: true, y: false }, points: { size: 6 } },
      hooks: { draw: [drawMarks(chart), drawLimits(chart)], setScale: [zoomAll] },
    };
  }

  let zooming = false;

  function zoomAll(u, scale) {
    if (scale !== "x" || zooming || plots.length < data.charts.length) return;
    zooming = true;
    const { min, max } = u.scales.x;
    for (const plot of plots) if (plot !== u) plot.setScale("x", { min, max });
    zooming = false;
  }

  const places = Array.from(document.querySelectorAll(".plot"));

  function fit(width) {
    plots.forEach((plot, number) => {
      const wanted = width || places[number].clientWidth;
      if (wanted && plot.width !== wanted) plot.setSize({ width: wanted, height: HEIGHT });
    });
  }

  const last = Math.max(data.seconds, 0.1);
  plots = places.map((place) => {
    const chart = data.charts[Number(place.dataset.chart)];
    return new uPlot(options(chart, place.clientWidth || PRINT_WIDTH), columns(chart), place);
  });
  if (plots.length) plots[0].setScale("x", { min: 0, max: last });
  places.forEach((place, number) => place.addEventListener("dblclick", () => {
    plots[number].setScale("x", { min: 0, max: last });
  }, true));

  let waiting = 0;
  window.addEventListener("resize", () => {
    cancelAnimationFrame(waiting);
    waiting = requestAnimationFrame(() => fit(0));
  });
  // Paper is light, and has a width of its own.
  window.addEventListener("beforeprint", () => {
    show("light");
    fit(PRINT_WIDTH);
  });
  window.addEventListener("afterprint", () => {
    show(theme());
    fit(0);
  });
})();
