// The page: what stands where, and what is drawn again when something has changed.

function block(title, ...children) { return element("section", {}, element("h2", {}, title), children); }

function replace(holder, words) { holder.replaceChildren(...words.flat().filter(word => word !== null && word !== undefined)); }

const holders = Object.fromEntries(["status", "facts", "result", "health", "history", "log", "token"].map(name => [name, element("div", {id: name})]));
const commands = command_bar(), view = live_view(), touched = touch_chart(), drifted = drift_chart();
const none_yet = paragraph("None heard since the page's server was started.", "soft");
const fleet = fleet_list(name => { choose_robot(name); commands.clear(); show_all(); window.scrollTo({top: 0}); });

function ask_token() {
  const input = element("input", {type: "password", autocomplete: "off", "aria-label": "token"}), button = element("button", {class: "main"}, "Show");
  const take = () => { sessionStorage.setItem("selfcal-token", input.value.trim()); link.asks_token = false; show_link(); };
  button.addEventListener("click", take);
  input.addEventListener("keydown", event => { if (event.key === "Enter") take(); });
  replace(holders.token, [element("div", {class: "verdict"}, element("h1", {}, "This page needs its token"),
    paragraph("It was printed when the page was started, or stands in the file that was given to it."),
    element("div", {class: "buttons"}, input, button))]);
}

function show_link() {
  const place = document.getElementById("link");
  place.textContent = link.problem ? link.problem : "live";
  place.className = link.problem ? "broken" : "";
  const asks = link.asks_token;
  for (const each of page.children) if (each !== holders.token) each.style.display = asks ? "none" : "";
  if (asks && !holders.token.firstChild) ask_token();
  if (!asks) holders.token.replaceChildren();
}

function line_of_robot() { return (link.domain.fleet || []).find(line => line.robot === link.robot); }

const SHOWS = [
  [["status", "progress", "silence", "fleet"], () => replace(holders.status, [status_card(link.parts, line_of_robot())])],
  [["status", "cell"], () => replace(holders.facts, [status_facts(link.parts.status, link.parts.cell)])],
  [["cell", "pose", "touches"], () => view.show(link.parts.cell, link.parts.pose, link.lists.touches || [])],
  [["touches"], () => {
    const touches = link.lists.touches || [];
    touched.figure.hidden = touches.length === 0;
    none_yet.hidden = touches.length > 0;
    touched.show(touches);
  }],
  [["result"], () => replace(holders.result, result_words(link.parts.result))],
  [["result", "status"], () => hide_told_above(link.parts.status)],
  [["health"], () => replace(holders.health, health_words(link.parts.health))],
  [["history"], () => { replace(holders.history, history_words(link.parts.history)); drifted.show(link.parts.history); }],
  [["history", "news"], () => replace(holders.log, log_words(link.parts.history, link.lists.news))],
  [["fleet"], () => fleet.show(link.domain.fleet || [], link.robot)],
];

function show_all() { for (const [, show] of SHOWS) show(); }

function show_changes(changed) {
  const robots = link.domain.fleet || [];
  if (!link.robot && robots.length) choose_robot(robots[0].robot);
  const name = link.robot || "selfcal";
  document.getElementById("name").textContent = name;
  const state = (link.parts.status || {}).state;
  document.title = (state ? state + " · " : "") + name;
  if (link.domain.server) document.getElementById("made").textContent = "selfcal " + link.domain.server.version + ", live.";
  show_link();
  for (const [parts, show] of SHOWS) if (parts.some(part => changed.has(part))) show();
  commands.show(link.parts.status, link.domain.server || {commands: false});
}

function draw_all() {
  draw_charts();
  for (const draw of drawn.views) draw();
  show_all();
}

link.robot = take_from_hash();
page.replaceChildren(holders.token, fleet.section, holders.status, commands.bar, holders.facts,
  element("div", {class: "beside"}, block("In its cell", view.figure), block("Touches", none_yet, touched.figure)),
  block("Last result", holders.result), block("Health", holders.health), block("Past sessions", drifted.figure, holders.history), block("Log", holders.log));
draw_all();
window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw_all);
follow(show_changes);
