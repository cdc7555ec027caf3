// page.js - see page.html.  SPDX-License-Identifier: GPL-3.0-or-later
"use strict";

const $ = id => document.getElementById(id);
const view = $("view"), ink = view.getContext("2d", { alpha: false, desynchronized: true });
let about = null, status = null, shown = 0, natural = 1, following = false, recording = "";
const series = [];                      // of the curves: one status each picture
const SERIES_MAX = 4000;
const meter = { frames: 0, since: performance.now(), rate: 0 };

// ---- commands ----------------------------------------------------------------------------------

async function send(line) {
  const answer = await fetch("command", { method: "POST", body: line });
  return answer.ok ? answer.json() : { ok: false, text: await answer.text() };
}

function tell(text, bad) {
  $("reply").textContent = text;
  $("reply").hidden = !text;
  $("reply").classList.toggle("bad", !!bad);
}

async function command(line) {
  const reply = await send(line);
  tell(reply.text, !reply.ok);
  return reply;
}

// At most one command of a slider is under way, and the last value always arrives.
function steady(act) {
  let busy = false, waiting = null;
  return async function run(value) {
    if (busy) { waiting = [value]; return; }
    busy = true;
    await act(value);
    await new Promise(done => setTimeout(done, 150));
    busy = false;
    if (waiting) { const [next] = waiting; waiting = null; run(next); }
  };
}

// ---- pictures ----------------------------------------------------------------------------------

// Raw pixels are quickest on this machine; over a slow line they would not be, so when a picture
// takes long to come, compressed ones are asked for instead.
const line = { as: "raw", slow: 0 };

async function draw(answer) {
  const [width, height] = answer.headers.get("X-Size").split("x").map(Number);
  const start = performance.now();
  const buffer = await answer.arrayBuffer();
  if (view.width !== width || view.height !== height) { view.width = width; view.height = height; }
  if (answer.headers.get("Content-Type") !== "image/png") {
    ink.putImageData(new ImageData(new Uint8ClampedArray(buffer), width, height), 0, 0);
    line.slow = performance.now() - start > 80 ? line.slow + 1 : 0;
    if (line.slow > 5) line.as = "png";
  } else {
    const picture = await createImageBitmap(new Blob([buffer], { type: "image/png" }));
    ink.drawImage(picture, 0, 0);
    picture.close();
  }
  meter.frames++;
}

function ask() { return fetch(`frame?after=${shown}&as=${line.as}&rate=60`); }

// The next picture is asked for before this one is shown, so that both machines work at once.
async function watch() {
  let coming = ask();
  for (;;) {
    try {
      const answer = await coming;
      if (!answer.ok) throw new Error(await answer.text());
      const text = answer.headers.get("X-Status");
      if (answer.status === 200) {
        shown = Number(answer.headers.get("X-Frame"));
        coming = ask();
        coming.catch(() => {});         // told when it is awaited
        await draw(answer);
      } else {
        const news = await (await fetch("news")).json();
        if (!news.ok) tell(news.text, true);
        coming = ask();
      }
      if (text) take(JSON.parse(text));
    } catch (trouble) {
      $("facts").textContent = "the session is over";
      await new Promise(done => setTimeout(done, 1000));
      coming = ask();
    }
    if (document.hidden) await new Promise(done =>
      document.addEventListener("visibilitychange", done, { once: true }));
  }
}

const format = (x, digits = 4) => x === null || x === undefined ? "–"
  : Math.abs(x) >= 1e6 || (x && Math.abs(x) < 1e-3) ? x.toExponential(digits - 2)
  : String(Number(x.toPrecision(digits)));

function take(news) {
  if (news.scale === undefined && status) Object.assign(news, { scale: status.scale,
    x0: status.x0, y1: status.y1 });
  status = news;
  const now = performance.now();
  if (now - meter.since > 1000) {
    meter.rate = meter.frames * 1000 / (now - meter.since);
    meter.frames = 0;
    meter.since = now;
  }
  $("play").textContent = news.running ? "Pause" : "Play";
  $("done").value = Math.min(1, news.time / news.until);
  $("facts").textContent = `t = ${format(news.time, 5)} ${about ? about.time_unit : ""}   `
    + `${news.grains} grains   ${format(news.rate, 3)} ${about ? about.work : "steps"}/s   `
    + `${meter.rate.toFixed(0)} pictures/s`;
  const last = series[series.length - 1];
  if (last && news.time < last.time) {
    while (series.length && series[series.length - 1].time > news.time) series.pop();
  }
  if (!last || news.time > last.time) series.push(news);
  if (series.length > SERIES_MAX) series.splice(0, SERIES_MAX / 2,
    ...series.slice(0, SERIES_MAX / 2).filter((_, k) => k % 2));
}

// ---- curves ------------------------------------------------------------------------------------

const energy = s => (s.kinetic_energy || 0) + (s.rotational_energy || 0);
const curves = {
  "kinetic energy": s => s.kinetic_energy,
  "energy of motion and rotation": energy,
  "potential energy": s => s.potential_energy,
  "grains": s => s.grains,
  "flux out: grains per time": "grains_out",
  "flux in: grains per time": "grains_in",
  "collisions per time": "collisions",
};

// A name is a total: its rate over some pictures.
function values(curve) {
  if (typeof curve !== "string") return series.map(s => [s.time, curve(s)]);
  const span = Math.max(1, Math.floor(series.length / 60)), points = [];
  for (let k = span; k < series.length; k++) {
    const a = series[k - span], b = series[k];
    if (b.time > a.time) points.push([b.time, (b[curve] - a[curve]) / (b.time - a.time)]);
  }
  return points;
}

function plot() {
  const canvas = $("plot"), pen = canvas.getContext("2d"), style = getComputedStyle(document.body);
  const points = values(curves[$("curve").value]).filter(p => Number.isFinite(p[1]));
  pen.clearRect(0, 0, canvas.width, canvas.height);
  if (points.length < 2) return;
  const left = 90, right = canvas.width - 12, top = 14, bottom = canvas.height - 36;
  const t0 = points[0][0], t1 = points[points.length - 1][0];
  let low = Math.min(0, ...points.map(p => p[1])), high = Math.max(...points.map(p => p[1]));
  if (high <= low) high = low + 1;
  const x = t => left + (t - t0) / (t1 - t0 || 1) * (right - left);
  const y = v => bottom - (v - low) / (high - low) * (bottom - top);
  pen.font = "20px system-ui, sans-serif";
  pen.fillStyle = style.getPropertyValue("--soft");
  pen.strokeStyle = style.getPropertyValue("--line");
  pen.lineWidth = 1.5;
  for (let k = 0; k <= 2; k++) {
    const v = low + (high - low) * k / 2;
    pen.beginPath(); pen.moveTo(left, y(v)); pen.lineTo(right, y(v)); pen.stroke();
    pen.textAlign = "right"; pen.fillText(format(v, 3), left - 8, y(v) + 7);
  }
  pen.textAlign = "left"; pen.fillText(format(t0, 3), left, canvas.height - 8);
  pen.textAlign = "right"; pen.fillText("t = " + format(t1, 4), right, canvas.height - 8);
  pen.strokeStyle = style.getPropertyValue("--accent");
  pen.lineWidth = 3;
  pen.beginPath();
  points.forEach(([t, v], k) => k ? pen.lineTo(x(t), y(v)) : pen.moveTo(x(t), y(v)));
  pen.stroke();
}

// ---- the hand ----------------------------------------------------------------------------------

function place(event) {
  const box = view.getBoundingClientRect();
  const px = (event.clientX - box.left) * view.width / box.width;
  const py = (event.clientY - box.top) * view.height / box.height;
  return { px: event.clientX - box.left, py: event.clientY - box.top,
    x: status.x0 + px / status.scale, y: status.y1 - py / status.scale };
}

const digits = x => Number(x.toPrecision(7));

async function inspect(point, event) {
  const reply = await send(`inspect ${digits(point.x)} ${digits(point.y)}`);
  if (!reply.ok) { tell(reply.text, true); return; }
  const grain = JSON.parse(reply.text), tip = $("tip"), rows = document.createElement("table");
  const facts = { grain: grain.id, position: `${format(grain.x)}, ${format(grain.y)}`,
    velocity: `${format(grain.vx)}, ${format(grain.vy)}`, spin: format(grain.spin),
    radius: format(grain.radius), mass: format(grain.mass), contacts: grain.contacts.length };
  for (const [name, value] of Object.entries(facts)) {
    const row = rows.insertRow();
    row.insertCell().textContent = name;
    row.insertCell().textContent = value;
  }
  const follow = document.createElement("button");
  follow.textContent = "Follow";
  follow.onclick = () => { command(`follow ${grain.id}`); following = true;
    $("unfollow").hidden = false; tip.hidden = true; };
  tip.replaceChildren(rows, follow);
  const frame = $("frame").getBoundingClientRect();
  tip.hidden = false;
  tip.style.left = Math.min(event.clientX - frame.left + 12, frame.width - tip.offsetWidth) + "px";
  tip.style.top = Math.min(event.clientY - frame.top + 12, frame.height - tip.offsetHeight) + "px";
}

// A drag over some distance gives the grains the speed to go that far in a quarter of a second.
const PUSH_SECONDS = 0.25, CLICK_PIXELS = 5;
let drag = null;

view.addEventListener("pointerdown", event => {
  if (!status || status.scale === undefined || event.button) return;
  view.setPointerCapture(event.pointerId);
  drag = { from: place(event), shift: event.shiftKey };
  $("tip").hidden = true;
});
view.addEventListener("pointermove", event => {
  if (!drag || drag.shift) return;
  const to = place(event), line = $("arrow").querySelector("line"), offset = view.offsetLeft;
  line.setAttribute("x1", drag.from.px + offset); line.setAttribute("y1", drag.from.py);
  line.setAttribute("x2", to.px + offset); line.setAttribute("y2", to.py);
  $("arrow").querySelector("circle").setAttribute("cx", to.px + offset);
  $("arrow").querySelector("circle").setAttribute("cy", to.py);
  $("arrow").style.visibility = "visible";
});
view.addEventListener("pointerup", event => {
  if (!drag) return;
  const from = drag.from, to = place(event), shift = drag.shift;
  drag = null;
  $("arrow").style.visibility = "hidden";
  const far = Math.hypot(to.px - from.px, to.py - from.py);
  if (far < CLICK_PIXELS) { inspect(to, event); return; }
  if (shift) {
    const box = view.getBoundingClientRect();
    command(`pan ${digits((from.px - to.px) / box.width)} ${digits((to.py - from.py) / box.height)}`);
    return;
  }
  const time = PUSH_SECONDS * (status.speed || natural);
  command(`push ${digits(from.x)} ${digits(from.y)} ${digits((to.x - from.x) / time)} `
    + `${digits((to.y - from.y) / time)}`);
});
const zoom = steady(([factor, point]) =>
  command(`zoom ${digits(factor)} ${digits(point.x)} ${digits(point.y)}`));
view.addEventListener("wheel", event => {
  event.preventDefault();
  if (status) zoom([Math.exp(-event.deltaY / 400), place(event)]);
}, { passive: false });

// ---- keys of the scene -------------------------------------------------------------------------

const change = steady(([path, value]) => command(`set ${path} ${value}`));

// A slider reaches from zero (or the key's limits) to twice the value; others are written.
function slider(key) {
  const range = document.createElement("input"), text = document.createElement("input");
  const reach = Math.abs(key.number) || 1;
  range.type = "range";
  range.min = key.low > 0 && key.low < 1e-100 ? reach / 100 : key.low ?? (key.number < 0
    ? -2 * reach : 0);
  range.max = key.high ?? 2 * reach;
  range.step = "any";
  range.value = key.number;
  text.type = "text";
  text.value = format(key.number, 6);
  range.oninput = () => { text.value = format(Number(range.value), 4);
    change([key.path, text.value]); };
  text.onchange = () => { range.value = text.value; command(`set ${key.path} ${text.value}`); };
  range.dataset.path = key.path;
  return [range, text];
}

function field(key) {
  if (key.number !== undefined && key.number !== null) return slider(key);
  let input;
  if (key.choices) {
    input = document.createElement("select");
    for (const word of key.choices) input.add(new Option(word, word));
    input.value = (key.text || "").replace(/"/g, "");
  } else {
    input = document.createElement("input");
    input.type = "text";
    input.className = "whole";
    input.value = key.text || "";
    input.placeholder = "chosen";
  }
  input.onchange = () => command(`set ${key.path} ${input.value}`);
  return [input];
}

let keys = [];
function showKeys() {
  const wanted = $("filter").value.trim();
  const list = keys.filter(key => wanted ? key.path.includes(wanted) || key.doc.includes(wanted)
    : key.number !== undefined && !key.path.startsWith("view.") || key.path === "gravity");
  $("keys").replaceChildren(...list.slice(0, 80).map(key => {
    const entry = document.createElement("div"), name = document.createElement("b");
    const row = document.createElement("div");
    entry.className = "key";
    name.textContent = key.path;
    name.title = `${key.doc} (${key.type}${key.unit ? ", " + key.unit : ""})`;
    row.append(...field(key));
    entry.append(name, row);
    return entry;
  }));
}

async function fetchKeys() {
  keys = await (await fetch("keys")).json();
  showKeys();
}

// ---- the rest ----------------------------------------------------------------------------------

function fill(select, words, verb) {
  for (const word of words) select.add(new Option(word, word));
  select.onchange = () => command(`${verb} ${select.value}`);
}

const quote = word => /^[\w.,=:\/-]+$/.test(word) ? word : `'${word.replace(/'/g, `'\\''`)}'`;

// What makes this picture, or repeats all that was done by hand.
async function commandLine() {
  await fetchKeys();
  const words = ["sandreel", "frame", about.path, "-t", String(status.time)];
  for (const text of about.overrides) words.push("-s", text);
  for (const path of ["view.color", "view.colormap", "view.map", "view.window"]) {
    const key = keys.find(entry => entry.path === path);
    if (key && key.text && key.text !== '""') words.push("-s", `${path}=${key.text}`);
  }
  return words.map(quote).join(" ") + `   # or: sandreel replay ${quote(about.directory)}`;
}

function speedText(value) { return `${format(value * 1, 3)}×`; }

function listen() {
  for (const button of document.querySelectorAll("[data-command]")) {
    button.onclick = () => command(button.dataset.command);
  }
  $("play").onclick = () => command(status && status.running ? "pause" : "go");
  $("speed").oninput = () => {
    const top = Number($("speed").value) >= 3;
    const factor = Math.pow(10, Number($("speed").value));
    $("speed-text").textContent = top ? "max" : speedText(factor);
    send(top ? "speed max" : `speed ${digits(natural * factor)}`);
  };
  $("tilt").oninput = () => {
    $("tilt-text").textContent = $("tilt").value + "°";
    tilt($("tilt").value);
  };
  $("pour").onclick = () => command("pour 50");
  $("unfollow").onclick = () => { command("follow"); $("unfollow").hidden = true; };
  $("filter").oninput = showKeys;
  $("prompt").onsubmit = event => {
    event.preventDefault();
    const text = $("line").value.trim();
    if (text) command(text).then(reply => { if (reply.ok) $("line").value = ""; });
  };
  $("record").onclick = async () => {
    const name = recording || `film-${Date.now() % 1e8}.mp4`;
    const reply = await command(recording ? "movie stop" : `movie ${name} start`);
    if (reply.ok) recording = recording ? "" : name;
    $("record").textContent = recording ? "Stop recording" : "Record";
    $("record").classList.toggle("on", !!recording);
  };
  $("copy").onclick = async () => {
    const text = await commandLine();
    try { await navigator.clipboard.writeText(text); } catch { /* shown below */ }
    tell(text);
  };
  $("theme").onclick = () => dark(!document.documentElement.classList.contains("dark"));
  for (const details of document.querySelectorAll("details")) {
    details.addEventListener("toggle", () => { if (details.open) fetchKeys(); });
  }
  document.addEventListener("keydown", event => {
    if (/INPUT|SELECT|TEXTAREA/.test(event.target.tagName) || event.ctrlKey || event.metaKey
      || event.altKey) return;
    if (event.key === ":") { event.preventDefault(); $("line").focus(); return; }
    const key = about && about.keyboard.find(entry => entry.key === event.key);
    if (!key || key.running === "quit") return;
    event.preventDefault();
    command(status && status.running ? key.running : key.resting);
  });
}

const tilt = steady(angle => command(`tilt ${angle}`));

function dark(on) {
  document.documentElement.classList.toggle("dark", on);
  send(`set view.theme "${on ? "dark" : "white"}"`);
}

async function begin() {
  about = await (await fetch("about")).json();
  natural = about.speed || 1;
  document.title = `${about.name} – sandreel`;
  $("title").textContent = `${about.title || about.name} · ${about.model}`;
  $("directory").textContent = about.directory;
  $("speed-text").textContent = speedText(1);
  fill($("color"), about.colors, "color");
  fill($("colormap"), about.colormaps, "set view.colormap");
  fill($("map"), ["none", ...about.maps], "map");
  for (const name of Object.keys(curves)) $("curve").add(new Option(name, name));
  for (const entry of about.commands) $("commands").append(new Option(entry.usage, entry.name));
  for (const entry of about.keyboard.filter(key => key.running !== "quit")) {
    const key = document.createElement("dt"), doc = document.createElement("dd");
    key.textContent = entry.name;
    doc.textContent = entry.doc;
    $("keyboard").append(key, doc);
  }
  await fetchKeys();
  for (const [id, path] of [["color", "view.color"], ["colormap", "view.colormap"],
    ["map", "view.map"]]) {
    const key = keys.find(entry => entry.path === path);
    const word = key && key.text ? key.text.replace(/"/g, "") : "";
    $(id).value = word || "none";
  }
  listen();
  if (matchMedia("(prefers-color-scheme: dark)").matches) dark(true);
  setInterval(plot, 500);
  watch();
}

begin();
