// The page from its object: the verdict first, then what each kind of page has to say.

const data = JSON.parse(document.getElementById("data").textContent);

const KINDS = {
  identification: ["Calibration", show_identification],
  diagnosis: ["Diagnosis", show_diagnosis],
  history: ["History", show_history],
};

function show_verdict(title) {
  const verdict = data.verdict;
  const effects = data.kind === "diagnosis" ? data.result.candidates.map(each => each.effect) : [];
  const next = (verdict.next || []).map(each => in_words(each, effects));
  const name = data.robot.name + (data.data ? " · " + data.data.name : "");
  page.append(element("p", {class: "kicker"}, title + " of " + name));
  page.append(element("div", {class: "verdict " + (verdict.answer || "")},
    element("h1", {}, in_words(verdict.sentence, effects)),
    next.length === 1 ? element("p", {class: "next"}, element("b", {}, "Next: "), next[0])
      : next.length ? element("div", {class: "next"}, element("b", {}, "Next"), bullets(next)) : null,
    verdict.why ? paragraph(verdict.why, "soft") : null));
}

function show_facts() {
  const from = data.data;
  const session = data.session || {};
  page.append(facts([
    ["robot", data.robot.name + (data.robot.kind ? " (" + data.robot.kind + ")" : "")],
    ["data", from ? from.name : ""],
    ["rows", from ? from.rows : ""],
    ["sets", from ? from.sets.map(set => set.name + " (" + set.method + ")").join(", ") : ""],
    ["measured", session.when],
    ["begun", session.reason],
    ["decision", session.decision],
    ["page made", data.made],
    ["version", "selfcal " + data.version],
    ["model hash", data.robot.model_hash],
  ]));
}

const [title, show] = KINDS[data.kind];
document.title = title + " of " + data.robot.name;
document.getElementById("made").textContent = "Made by selfcal " + data.version + " on " + data.made + ".";
show_verdict(title);
show_facts();
show(data);

function draw_all() {
  draw_charts();
  for (const draw of drawn.views) draw();
}
draw_all();
window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw_all);

// Printers want dark on light: the style of the screen's light scheme, charts and views drawn again.
const LIGHT = {paper: "#ffffff", card: "#f4f6f9", ink: "#17202b", soft: "#566373", line: "#d5dbe3",
               before: "#d55e00", after: "#0072b2", good: "#00735a", bad: "#a83a00", open: "#7a5c00"};
window.addEventListener("beforeprint", () => {
  for (const each of document.querySelectorAll("details")) each.open = true;
  for (const [name, value] of Object.entries(LIGHT)) document.documentElement.style.setProperty("--" + name, value);
  draw_all();
});
window.addEventListener("afterprint", () => {
  for (const name of Object.keys(LIGHT)) document.documentElement.style.removeProperty("--" + name);
  draw_all();
});
