// One robot, section by section; each is drawn again when its part has changed.

const LEVELS = {ok: "● ok", none: "● well", warn: "▲ warning", warning: "▲ warning", waits: "▲ waits", error: "■ error",
                silent: "○ silent", stale: "○ stale"};

function level_mark(level) { return element("span", {class: "level " + level}, LEVELS[level] || level); }

function moment(unix_ms) {
  return new Intl.DateTimeFormat("en-GB", {day: "numeric", month: "short", year: "numeric", hour: "2-digit", minute: "2-digit"}).format(unix_ms);
}
function clock(unix_ms) { return new Date(unix_ms).toLocaleTimeString("en-GB"); }

function span(seconds) {
  if (!known(seconds)) return "";
  if (seconds < 90) return Math.round(seconds) + " s";
  if (seconds < 5400) return Math.round(seconds / 60) + " min";
  return figure(seconds / 3600, 2) + " h";
}

function progress_words(progress, silent) {
  let text = progress.done + " of " + plural(progress.planned, "touch", "touches");
  if (progress.put_aside > 0) text += ", " + progress.put_aside + " put aside";
  if (progress.done < progress.planned && known(progress.seconds_left) && !silent) text += ", " + span(progress.seconds_left) + " left";
  if (progress.set === "" && progress.note) text += ": " + progress.note;
  return text;
}

function status_card(parts, line) {
  const {status, progress} = parts, silent = (parts.silence || {}).silent > 0;
  if (!status) return element("div", {class: "verdict"}, element("h1", {}, link.robot || "No robot yet"),
    paragraph(link.robot ? "no status heard yet" : "Robots appear here as their services are heard in this DDS domain.", "soft"));
  const concern = silent ? "silent" : line ? line.concern : "none";
  const session = status.session > 0 ? ", session " + status.session + (status.kind ? " (" + status.kind + ")" : "") : "";
  const runs = progress && progress.session === status.session && progress.planned > 0 &&
    !["idle", "self-test", "planning", "awaiting-acceptance"].includes(status.state);
  const share = runs ? Math.min(1, progress.done / progress.planned) : 0;
  const bar = runs ? element("div", {class: "bar", role: "progressbar", "aria-valuemin": 0, "aria-valuemax": progress.planned,
                                     "aria-valuenow": progress.done}, element("div", {})) : null;
  if (bar) bar.firstChild.style.width = 100 * share + "%";
  return element("div", {class: "verdict " + concern},
    element("div", {class: "state-line"}, level_mark(concern), element("span", {class: "kicker"}, silent ? "what the robot may do is not known" : "the robot may " + status.hardware)),
    element("h1", {id: "state"}, (silent ? "Silent for " + span(parts.silence.silent) + "; last heard: " : "") + status.state +
      (status.phase ? ", " + status.phase : "") + session),
    paragraph(status.why), line && line.why && line.why !== status.why ? paragraph(line.why, "soft") : null, bar, runs ? paragraph(progress_words(progress, silent), "soft") : null);
}

function status_facts(status, cell) {
  if (!status) return null;
  const other = cell && cell.model_hash !== status.model_hash;
  return facts([
    ["active", status.active === "factory" ? "the factory's parameters" : status.active +
      (status.active_since_ms > 0 ? ", since " + moment(status.active_since_ms) : "")],
    ["next due", status.next_due_ms > 0 ? moment(status.next_due_ms) : "when asked"],
    ["temperature", known(status.temperature) ? figure(status.temperature) + " °C" : ""],
    ["service", "selfcal " + status.version],
    ["drawing", other ? "of another model than the service has: is it the right configuration?" : ""],
  ]);
}

// {figure, show(touches)}: residual of each touch against the model and surface as known so far.
function touch_chart() {
  let touches = [];
  // Of the first touches of a surface there is no residual; one that was put aside is marked on the axis.
  const numbered = () => touches.map(touch => ({x: touch.index + 1, y: known(touch.residual) ? 1e6 * touch.residual : 0, touch}))
    .filter(({touch}) => known(touch.residual) || !touch.accepted);
  const named = point => Object.assign(point, {name: point.touch.set});
  const make = () => {
    const points = numbered();
    const configured = scatter([
      dots(points.filter(point => point.touch.accepted).map(named), "taken", "after"),
      dots(points.filter(point => !point.touch.accepted).map(named), "put aside", "before", {pointStyle: "triangle", pointRadius: 6}),
    ], "touch", "missed by, µm", {x: {min: 0, suggestedMax: 12, ticks: {precision: 0}}});
    configured.options.plugins.tooltip.callbacks.label = item => item.raw.name + ": " +
      (item.raw.touch.accepted ? figure(item.raw.y) + " µm" : item.raw.touch.note);
    return configured;
  };
  const note = element("p", {class: "soft"});
  const made = chart(make, "How far each touch lies from where the active parameters and the surface, as known so far, have it.", "tall");
  const entry = drawn[drawn.length - 1];
  return {figure: element("div", {}, made, note), show(list) {
    touches = list;
    const first = touches.filter(touch => touch.accepted && !known(touch.residual)).length;
    note.textContent = first === 0 ? "" : plural(first, "touch is", "touches are") +
      " taken and not drawn: a surface's first touches find where it lies, and can miss nothing.";
    made.hidden = list.length > 0 && numbered().length === 0;
    if (!entry.chart || list.length === 0) return;
    entry.chart.resize();
    entry.chart.data = make().data;
    entry.chart.update("none");
  }};
}

function result_words(result) {
  if (!result) return [paragraph("No result yet.", "soft")];
  const decision = result.decision === "none" ? "" : ", " + result.decision;
  const sets = (result.sets || []).map(set => [set.name, String(set.rows), mm(set.before), mm(set.after)]);
  return [
    paragraph("Session " + result.session + " (" + result.kind + "), " + moment(result.unix_ms) + ": " + result.answer + decision),
    residual_tiles(result),
    paragraph(plural(result.touches, "touch", "touches") + (result.rejected ? ", " + result.rejected + " put aside" : "") +
      (result.identified ? ", " + plural(result.identified, "parameter") + " identified" : "") + ".", "soft"),
    element("p", {class: "soft", id: "result-why"}, result.why),
    sets.length ? folded("Surface by surface", table([{title: "surface"}, {title: "rows kept aside", number: true},
      {title: "before, mm", number: true}, {title: "after, mm", number: true}], sets)) : null,
    result.changes ? folded("What moved most, from the maker's figures", ...[change_table(result.changes)].flat()) : null,
    (result.warnings || []).length ? folded(plural(result.warnings.length, "warning"), bullets(result.warnings)) : null,
  ];
}

// The state that follows a result has its reason, which stands above.
function hide_told_above(status) {
  const why = document.getElementById("result-why");
  if (why) why.hidden = Boolean(status) && why.textContent === status.why;
}

function health_words(health) {
  if (!health) return [paragraph("Nothing heard yet.", "soft")];
  const rows = health.lines.map(line => [line.name.replace("selfcal: ", ""), level_mark(line.level), line.message,
    Object.entries(line.values).filter(([key, value]) => !["hardware", "session"].includes(key) && value !== "nan").map(([key, value]) => key.replace(/_/g, " ") + " " + value).join(" · ")]);
  return [table([{title: "part"}, {title: "state"}, {title: "says"}, {title: "figures"}], rows)];
}

function history_words(history) {
  if (!history) return [paragraph("Past sessions are read where the robot's configuration is given: selfcal monitor --web ADDRESS:PORT CONFIG.yaml", "soft")];
  if (history.problem) return [paragraph("Its store cannot be read: " + history.problem, "soft")];
  const rows = history.sessions.map(session => {
    const result = session.result, full = session.kind !== "check";
    return [String(session.session), moment(result ? result.unix_ms : session.started_ms), session.kind,
      result ? result.answer : session.state, result && result.decision !== "none" ? result.decision : "",
      result ? mm(result.check_before) : "", result ? mm(result.check_after) : "", result && full ? mm(result.endpoint_sigma) : "",
      result ? String(result.touches) : ""];
  });
  const number = title => ({title, number: true}), newest = 8;
  const listed = some => table([{title: "session"}, {title: "when"}, {title: "kind"}, {title: "answer"}, {title: "decision"}, number("before, mm"),
    number("after, mm"), number("end position, mm"), number("touches")], some);
  return [listed(rows.slice(0, newest)) || paragraph("No session yet.", "soft"),
          rows.length > newest ? folded(plural(rows.length - newest, "earlier session"), listed(rows.slice(newest))) : null];
}

// {figure, show(history)}: what touches kept aside were missed by, over the sessions.
function drift_chart() {
  let points = {before: [], after: []};
  const make = () => {
    const configured = scatter([
      dots(points.before, "with the parameters active then", "before", {showLine: true, borderWidth: 1.5, pointRadius: 4, pointStyle: "triangle"}),
      dots(points.after, "with those found", "after", {showLine: true, borderWidth: 1.5, pointRadius: 4}),
    ], "session", "missed by, mm", {x: {ticks: {precision: 0, stepSize: 1}}, y: {type: "logarithmic", ticks: {callback: decade_tick}}});
    return configured;
  };
  const made = chart(make, "What touches kept aside were missed by (rms), session by session.", "small");
  const entry = drawn[drawn.length - 1];
  return {figure: made, show(history) {
    const full = (history ? history.sessions : []).filter(session => session.result && session.kind === "full").reverse();
    const at = key => full.filter(session => session.result[key] > 0).map(session => ({x: session.session, y: 1e3 * session.result[key],
      name: "session " + session.session}));
    points = {before: at("check_before"), after: at("check_after")};
    made.hidden = points.before.length < 2;
    if (!entry.chart || made.hidden) return;
    entry.chart.resize();
    entry.chart.data = make().data;
    entry.chart.update("none");
  }};
}

function log_words(history, news) {
  const lines = history && !history.problem && history.events.length ? history.events : (news || []).slice().reverse();
  if (lines.length === 0) return [paragraph("Nothing yet.", "soft")];
  const today = new Date().toDateString();
  return [element("div", {class: "log", tabindex: 0}, lines.map(line => element("p", {},
    element("time", {}, new Date(line.unix_ms).toDateString() === today ? clock(line.unix_ms) : moment(line.unix_ms)),
    element("span", {}, line.level && line.level !== "info" ? level_mark(line.level === "warning" ? "warn" : line.level) : "",
      (line.level && line.level !== "info" ? " " : "") + line.text))))];
}
