// The link to the server: asks for what has changed, four times a second, and keeps what came.

const ASK_EVERY = 250, ASK_HIDDEN = 3000, ASK_LIMIT = 5000;  // ms

const link = {robot: "", epoch: "", version: 0, domain: {}, parts: {}, lists: {}, problem: "", asks_token: false};

function take_from_hash() {
  const hash = new URLSearchParams(location.hash.slice(1));
  if (hash.has("token")) {
    sessionStorage.setItem("selfcal-token", hash.get("token"));
    hash.delete("token");
    history.replaceState(null, "", hash.toString() ? "#" + hash : location.pathname);
  }
  return hash.get("robot") || "";
}

function own_headers(more = {}) {
  const token = sessionStorage.getItem("selfcal-token");
  return token ? Object.assign({Authorization: "Bearer " + token}, more) : more;
}

function forget_robot() {
  link.version = 0;
  link.parts = {};
  link.lists = {};
}

function choose_robot(name) {
  if (name === link.robot) return;
  link.robot = name;
  history.replaceState(null, "", "#robot=" + encodeURIComponent(name));
  forget_robot();
}

// Names of the parts and lists that came.
function take_changes(state) {
  if (state.epoch !== link.epoch) forget_robot();
  link.epoch = state.epoch;
  link.version = state.version;
  Object.assign(link.domain, state.domain);
  Object.assign(link.parts, state.parts);
  for (const [name, list] of Object.entries(state.lists || {}))
    link.lists[name] = list.restarted ? list.items : (link.lists[name] || []).concat(list.items).slice(-2000);
  return new Set([...Object.keys(state.domain || {}), ...Object.keys(state.parts || {}), ...Object.keys(state.lists || {})]);
}

async function ask_state() {
  const asked = link.robot;
  const query = new URLSearchParams({robot: asked, epoch: link.epoch, version: link.version});
  try {
    const answer = await fetch("/state?" + query, {headers: own_headers(), cache: "no-store", signal: AbortSignal.timeout(ASK_LIMIT)});
    const state = answer.ok ? await answer.json() : null, words = answer.ok ? "" : (await answer.text()).trim();
    link.asks_token = answer.status === 401;
    link.problem = link.asks_token ? "the token is missing or wrong" : words || (answer.ok ? "" : "the page's server says " + answer.status);
    return state && asked === link.robot ? take_changes(state) : new Set();
  } catch (error) {  // it may break off anywhere
    link.problem = "the page's server does not answer";
    return new Set();
  }
}

async function send_command(verb) {
  const {session, active, candidate} = link.parts.status;
  try {
    const answer = await fetch("/command", {
      method: "POST", headers: own_headers({"Content-Type": "application/json", "X-Selfcal-Command": "1"}),
      body: JSON.stringify({robot: link.robot, verb, seen: {session, active, candidate}}), signal: AbortSignal.timeout(2 * ASK_LIMIT)});
    const text = await answer.text();
    return answer.headers.get("Content-Type").startsWith("application/json") ? JSON.parse(text)
      : {accepted: false, why: text.trim()};
  } catch (error) {
    return {accepted: false, why: "the page's server does not answer"};
  }
}

// Calls `show` with what changed after every answer, for ever.
async function follow(show) {
  for (;;) {
    const changed = await ask_state();
    show(changed);
    const wait = document.hidden ? ASK_HIDDEN : link.problem ? 4 * ASK_EVERY : ASK_EVERY;
    await new Promise(resolve => setTimeout(resolve, wait));
  }
}
