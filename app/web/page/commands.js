// Buttons that command the robot, each asking first with what it will change.

const VERBS = {
  start: {title: "Start a session", able: status => idle(status)},
  check: {title: "Quick check", able: status => idle(status)},
  diagnose: {title: "Look for the cause", able: status => idle(status)},
  done: {title: "Done", main: true, able: status => status.state === "awaiting-person"},
  abort: {title: "Abort", stop: true, able: status => status.state !== "awaiting-acceptance"},  // one that is unfinished, too
  accept: {title: "Accept", main: true, able: status => status.candidate},
  reject: {title: "Reject", able: status => status.candidate},
  rollback: {title: "Roll back", able: status => status.active !== "factory"},
};

function idle(status) { return ["idle", "fault"].includes(status.state); }

function session_name(session) { return session > 0 ? "session " + session : "the factory's parameters"; }

function change_table(changes) {
  if (!changes) return paragraph("By how much each parameter changes is not known here.", "soft");
  if (changes.rows.length === 0) return paragraph("No parameter changes.");
  const rows = changes.rows.map(row => {
    const [factor, unit] = shown(row.unit), sigma = known(row.sigma) && row.sigma > 0 ? factor * row.sigma : null;
    const places = sigma ? decimals(sigma) : 3;
    const change = (row.change > 0 ? "+" : "") + fixed(factor * row.change, places);
    return [row.name, change + " " + unit, sigma ? "± " + fixed(1.96 * sigma, places) + " " + unit : ""];
  });
  const rest = changes.count - changes.rows.length;
  const columns = [{title: "parameter"}, {title: "change", number: true}, {title: "known to (95 %)", number: true}];
  const told = rows.some(row => row[2]) ? 3 : 2;
  return [table(columns.slice(0, told), rows.map(row => row.slice(0, told))),
          rest > 0 ? paragraph("and " + plural(rest, "smaller change"), "soft") : null];
}

function residual_tiles(result) {
  if (!result || result.answer === "failed") return null;
  const check = result.kind === "check";
  return tiles([
    [mm(result.check_before) + " mm", check ? "expected on new touches" : "touches kept aside are missed by, with the active parameters"],
    [mm(result.check_after) + " mm", check ? "found" : "with the parameters found"],
    known(result.endpoint_sigma) && !check ? [mm(result.endpoint_sigma) + " mm", "end position known to (1 sigma)"] : [null],
    known(result.p_value) ? [probability(result.p_value), check ? "probability of touches like these" : "probability by chance"] : [null],
  ]);
}

function motion_words(what) {
  return [paragraph("The robot moves by itself through its cell and touches its surfaces, " + what + ". Nobody may stand in its way."),
          paragraph("Parameters change only when a result is accepted, by a person or as the configuration has it.", "soft")];
}

function accept_words() {
  const {status, result, slots} = link.parts;
  const accept = slots && slots.accept, shown_result = result && result.session === status.session ? result : null;
  const known_from = accept && accept.session === (shown_result ? shown_result.session : accept.session);
  return [
    paragraph("The parameters of " + session_name(known_from ? accept.session : status.session) + " become active, in place of " +
      (status.active === "factory" ? "the factory's" : "those of " + status.active) + "; the robot's controller may read them at once. Roll back undoes it."),
    residual_tiles(shown_result),
    element("h3", {}, known_from ? "What changes against the active parameters" : "What changes against the maker's figures"),
    change_table(known_from ? accept.changes : shown_result && shown_result.changes)];
}

function rollback_words() {
  const {status, slots} = link.parts, back = slots && slots.rollback;
  const words = "What " + status.active + " found is given up and never comes back by itself; ";
  if (!back) return [paragraph(words + "the parameters before it become active. Which these are the page knows where the configuration is given.")];
  const since = back.since_ms > 0 ? ", in use before from " + moment(back.since_ms) : "";
  return [paragraph(words + (back.to > 0 ? "the parameters of session " + back.to + since : session_name(0)) + " become active."),
          element("h3", {}, "What changes"), change_table(back.changes)];
}

function words_for(verb) {
  const {status, progress, slots} = link.parts;
  switch (verb) {
    case "start": return motion_words("as often as its configuration says" + (progress && progress.kind === "full" && progress.planned ? " (" + progress.planned + " times in the last full session)" : ""));
    case "check": return motion_words("about a dozen times, and says whether the active parameters still explain them");
    case "diagnose": return motion_words("where that tells apart what may cause the gap that calibration leaves, and says what it is");
    case "done": return [paragraph("What the robot waits for is done: " + status.why + ". It moves on by itself, and nobody may stand in its way.")];
    case "abort": if (idle(status)) return [paragraph("A session that is unfinished ends without a result, and what it has collected stays in the store. " +
      "Nothing begins by itself then before a start.")];
      return [paragraph("Motion stops, and session " + status.session + " ends without a result." + (progress && progress.session === status.session
      ? " Its " + plural(progress.done, "touch", "touches") + " of " + progress.planned + " stay in the store." : "")),
      paragraph((status.active === "factory" ? "The factory's parameters" : "The parameters of " + status.active) + " stay active.", "soft")];
    case "accept": return accept_words();
    case "reject": return [paragraph("The result of " + session_name(slots && slots.accept ? slots.accept.session : status.session) + " is dropped. " +
      (status.active === "factory" ? "The factory's parameters" : "The parameters of " + status.active) + " stay active.")];
    default: return rollback_words();
  }
}

// Asks, and does it when the person says so; the answer goes to `say`.
function ask_first(verb, say) {
  const dialog = document.getElementById("ask"), {title, stop} = VERBS[verb];
  const yes = element("button", {class: stop ? "stop" : "main", id: "yes"}, title), no = element("button", {autofocus: ""}, "Not now");
  dialog.replaceChildren(element("h2", {id: "ask-title"}, title + ": " + link.robot), ...words_for(verb).flat().filter(Boolean),
    element("div", {class: "buttons decide"}, yes, no));
  no.addEventListener("click", () => dialog.close());
  yes.addEventListener("click", async () => {
    yes.disabled = no.disabled = true;
    const reply = await send_command(verb);
    dialog.close();
    say(verb, reply);
  });
  dialog.showModal();
}

// {bar, show(status)}
function command_bar() {
  const said = element("div", {role: "status"}), buttons = element("div", {class: "buttons"});
  const say = (verb, reply) => said.replaceChildren(element("p", {class: "said" + (reply.accepted ? "" : " refused")},
    "“" + VERBS[verb].title + "” was " + (reply.accepted ? "taken" : "refused") + (reply.why && reply.why !== verb ? ": " + reply.why : "") + "."));
  const made = Object.entries(VERBS).map(([verb, {title, main, stop}]) => {
    const button = element("button", {id: verb, class: stop ? "stop" : main ? "main" : ""}, title);
    button.addEventListener("click", () => ask_first(verb, say));
    return [verb, button];
  });
  buttons.append(...made.map(([, button]) => button));
  const only_shows = paragraph("This page only shows; it was started without --allow-commands.", "soft");
  return {bar: element("div", {}, buttons, only_shows, said), show(status, server) {
    buttons.hidden = !server.commands;
    buttons.style.display = server.commands ? "" : "none";
    only_shows.hidden = server.commands;
    // A service that is not heard does nothing, but may hear that it is to stop.
    const silent = (link.parts.silence || {}).silent > 0;
    for (const [verb, button] of made)
      button.disabled = !status || link.problem !== "" || !VERBS[verb].able(status) || (silent && verb !== "abort");
  }, clear() { said.replaceChildren(); }};
}
