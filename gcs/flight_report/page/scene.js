"use strict";
(() => {
  const canvas = document.getElementById("scene");
  const scene = JSON.parse(document.getElementById("data").textContent).scene;
  if (!canvas || !scene) return;
  const root = document.documentElement;
  const RAMP = [[60, 105, 200], [20, 150, 160], [95, 165, 75], [225, 160, 30]];
  const view = { turn: -0.6, tilt: 0.5, zoom: 1 };
  const [east, north, up] = scene.centre;
  const ground = Math.min(...scene.tracks.flatMap((track) => track.pieces.flat().map((p) => p[2])));

  function ink(name) {
    return getComputedStyle(root).getPropertyValue(name).trim();
  }

  function colour(share) {
    const place = share * (RAMP.length - 1), index = Math.min(Math.floor(place), RAMP.length - 2);
    const mixed = RAMP[index].map((low, i) => Math.round(low + (RAMP[index + 1][i] - low) * (place - index)));
    return "rgb(" + mixed.join(",") + ")";
  }

  function draw() {
    const width = canvas.clientWidth || 660, height = canvas.clientHeight || 360;
    canvas.width = width * devicePixelRatio;
    canvas.height = height * devicePixelRatio;
    const ctx = canvas.getContext("2d");
    ctx.scale(devicePixelRatio, devicePixelRatio);
    ctx.clearRect(0, 0, width, height);
    ctx.lineJoin = ctx.lineCap = "round";
    const scale = (0.62 * Math.min(width, 1.6 * height) * view.zoom) / (2 * scene.radius);
    const [sin, cos] = [Math.sin(view.turn), Math.cos(view.turn)];
    const [rise, flat] = [Math.sin(view.tilt), Math.cos(view.tilt)];

    function px(p) {
      const x = p[0] - east, y = p[1] - north, z = p[2] - up;
      return [width / 2 + scale * (x * cos + y * sin), height / 2 - scale * ((y * cos - x * sin) * rise + z * flat)];
    }

    function lines(places, style, thick, dash, closed) {
      ctx.strokeStyle = style;
      ctx.lineWidth = thick;
      ctx.setLineDash(dash || []);
      ctx.beginPath();
      places.forEach((p, i) => (i ? ctx.lineTo(...px(p)) : ctx.moveTo(...px(p))));
      if (closed) ctx.closePath();
      ctx.stroke();
      ctx.setLineDash([]);
    }

    function label(p, words, style) {
      ctx.fillStyle = style;
      ctx.font = "13px system-ui, sans-serif";
      ctx.strokeStyle = ink("--card");
      ctx.lineWidth = 3;
      ctx.strokeText(words, px(p)[0] + 6, px(p)[1] - 6);
      ctx.fillText(words, px(p)[0] + 6, px(p)[1] - 6);
    }

    const step = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000].find((each) => (2.4 * scene.radius) / each <= 12) || 10000;
    const reach = Math.ceil((1.2 * scene.radius) / step) * step;
    const [e0, n0] = [Math.round(east / step) * step, Math.round(north / step) * step];
    for (let at = -reach; at <= reach; at += step) {
      lines([[e0 + at, n0 - reach, ground], [e0 + at, n0 + reach, ground]], ink("--line"), 1);
      lines([[e0 - reach, n0 + at, ground], [e0 + reach, n0 + at, ground]], ink("--line"), 1);
    }
    label([e0, n0 + reach, ground], "north", ink("--soft"));
    label([e0 + reach, n0, ground], "east", ink("--soft"));
    ctx.fillText("a square is " + step + " m", 10, height - 10);
    for (const zone of scene.zones) {
      const style = ink(zone.inclusion ? "--good" : "--bad");
      for (const level of new Set([zone.floor ?? ground, zone.ceiling ?? ground])) {
        lines(zone.corners.map((c) => [c[0], c[1], level]), style, 1.2, [], true);
      }
      if (zone.ceiling == null || zone.corners.length > 12) continue;
      for (const c of zone.corners) lines([[c[0], c[1], zone.floor ?? ground], [c[0], c[1], zone.ceiling]], style, 0.8, [2, 3]);
    }
    for (const track of scene.tracks) {
      for (const piece of track.pieces) lines(piece.map((p) => [p[0], p[1], ground]), ink("--soft"), 1, [1, 3]);
      if (track.plan.length) {
        lines(track.plan, ink("--soft"), 1.5, [2, 4]);
        for (const p of track.plan) {
          ctx.beginPath();
          ctx.arc(...px(p), 3, 0, 7);
          ctx.stroke();
        }
      }
      for (const piece of track.pieces) {
        for (let i = 1; i < piece.length; i += 1) lines([piece[i - 1], piece[i]], track.colour ? ink(track.colour) : colour(piece[i][3]), 2.5);
      }
      const end = track.pieces.flat().at(-1);
      if (scene.tracks.length > 1 && end) label(end, track.name, ink("--ink"));
      if (track.trouble) {
        ctx.fillStyle = ink("--bad");
        ctx.beginPath();
        ctx.arc(...px(track.trouble), 6, 0, 7);
        ctx.fill();
      }
    }
  }

  const held = new Map();
  canvas.addEventListener("pointerdown", (event) => {
    held.set(event.pointerId, [event.clientX, event.clientY]);
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = held.get(event.pointerId);
    if (!before) return;
    if (held.size === 1) {
      turn(0.01 * (event.clientX - before[0]), 0.01 * (event.clientY - before[1]));
    } else {
      const other = [...held].find(([id]) => id !== event.pointerId)[1];
      const far = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]) || 1;
      zoom(far([event.clientX, event.clientY]) / far(before));
    }
    held.set(event.pointerId, [event.clientX, event.clientY]);
  });
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, (event) => held.delete(event.pointerId));
  canvas.addEventListener("wheel", (event) => {
    if (!event.ctrlKey && document.activeElement !== canvas) return;
    event.preventDefault();
    zoom(Math.exp(-0.002 * event.deltaY));
  }, { passive: false });
  const KEYS = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] };
  canvas.addEventListener("keydown", (event) => {
    if (event.key === "+" || event.key === "-") zoom(event.key === "+" ? 1.2 : 1 / 1.2);
    else if (KEYS[event.key]) turn(...KEYS[event.key]);
    else return;
    event.preventDefault();
  });

  function turn(right, down) {
    view.turn -= right;
    view.tilt = Math.max(0, Math.min(Math.PI / 2, view.tilt + down));
    draw();
  }

  function zoom(factor) {
    view.zoom = Math.max(0.3, Math.min(30, view.zoom * factor));
    draw();
  }

  for (const change of ["resize", "beforeprint", "afterprint"]) window.addEventListener(change, draw);
  new MutationObserver(draw).observe(root, { attributes: true, attributeFilter: ["data-theme"] });
  draw();
})();
