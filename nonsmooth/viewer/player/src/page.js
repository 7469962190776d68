// What stands in the page around the picture; buttons and other marks are real elements.

const ICONS = {
  play: "M4 2v12l10-6z",
  pause: "M3 2h4v12H3zM9 2h4v12H9z",
  back: "M13 2v12L5 8zM3 2h2v12H3z",
  forth: "M3 2v12l8-6zM11 2h2v12h-2z",
  help: "M6 6a2 2 0 1 1 3 2c-1 .5-1 1-1 2H7.5c0-1.5 0-2 1-2.7.8-.6.8-1.800-.5-1.800-.7 0-1 .4-1 1zM7 11h1.500v1.500H7z",
};

export function icon(name, size = 16) {
  return `<svg viewBox="0 0 16 16" width="${size}" height="${size}" aria-hidden="true"><path fill="currentColor" d="${ICONS[name]}"/></svg>`;
}

const KEYS = [
  ["Space", "play or pause"],
  ["← →", "a frame back or on"],
  ["[ ]", "the event before or after"],
  ["Home End", "begin or end"],
  ["- =", "slower or faster"],
  ["1 2 3 4", "look from a corner, the front, the side, the top"],
  ["T", "go with what moves"],
  ["F", "forces"],
  ["S", "slow motion round impacts"],
  ["L", "light or dark"],
  ["?", "this list"],
];

export const MARKUP = `
<main>
  <section id="picture" aria-label="picture"><canvas id="world" tabindex="0" aria-label="bodies in space; drag to look round"></canvas>
    <button id="start" aria-label="start" hidden>${icon("play", 32)}</button>
    <p id="trouble" role="status" hidden></p></section>
  <aside id="panel" tabindex="0" aria-label="what holds now">
    <h1></h1>
    <p id="status"></p>
    <dl><dt>time</dt><dd id="clock"></dd></dl>
    <table id="energies"><caption>energies [J]</caption><tbody></tbody></table>
    <ul class="key" aria-label="colours">${["stick", "slip", "impulse", "force"].map((one) => `<li><span class="${one}"></span>${one}</li>`).join("")}</ul>
    <dl><dt>mode</dt><dd id="word"></dd></dl>
    <p id="event" aria-live="polite"></p>
    <ul id="contacts" aria-label="closed contacts"></ul>
  </aside>
  <section id="steer" aria-label="time">
    <canvas id="strips" aria-hidden="true"></canvas>
    <div id="bar">
      <button id="back" aria-label="event before" title="event before  [">${icon("back")}</button>
      <button id="play" aria-label="play" title="play  Space">${icon("play")}</button>
      <button id="forth" aria-label="event after" title="event after  ]">${icon("forth")}</button>
      <input id="scrub" type="range" min="0" max="1000" step="1" value="0" aria-label="time">
      <label>speed <select id="speed" aria-label="speed"></select></label>
      <label><input id="slow" type="checkbox"> slow at impacts</label>
      <label><input id="forces" type="checkbox" checked> forces</label>
      <label><input id="follow" type="checkbox"> follow</label>
      <label>view <select id="view" aria-label="view"><option>corner</option><option>front</option><option>side</option><option>top</option></select></label>
      <button id="help" aria-label="keys" title="keys  ?" aria-expanded="false">${icon("help")}</button>
    </div>
    <div id="keys" hidden><table><caption>Keys</caption><tbody>${KEYS.map(([key, what]) => `<tr><th scope="row">${key}</th><td>${what}</td></tr>`).join("")}</tbody></table></div>
  </section>
</main>`;
