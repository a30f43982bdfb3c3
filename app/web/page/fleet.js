// All robots of the domain, the one that needs a person most first.

function fleet_row(line) {
  const result = line.result, progress = line.planned > 0 ? " (" + line.done + " of " + line.planned + ")" : "";
  return [line.robot, level_mark(line.concern), (line.state || "unknown") + progress, line.why || "",
    result ? result.answer + (result.decision !== "none" ? ", " + result.decision : "") + ", " + moment(result.unix_ms) : "none",
    known(line.off) ? mm(line.off) : "", line.next_due_ms > 0 ? moment(line.next_due_ms) : "when asked"];
}

// {section, show(fleet, chosen)}; `choose` hears of the robot that a person has chosen.
function fleet_list(choose) {
  const holder = element("div", {}), section_of_fleet = element("section", {id: "fleet"}, element("h2", {}, "Robots"), holder);
  return {section: section_of_fleet, show(fleet, chosen) {
    section_of_fleet.hidden = fleet.length < 2;
    if (section_of_fleet.hidden) return;
    const focused = document.activeElement && document.activeElement.dataset ? document.activeElement.dataset.robot : "";
    const made = table([{title: "robot"}, {title: "concern"}, {title: "state"}, {title: "why"}, {title: "last result"},
      {title: "off by, mm", number: true}, {title: "next due"}], fleet.map(fleet_row));
    [...made.tBodies[0].rows].forEach((row, i) => {
      row.dataset.robot = fleet[i].robot;
      row.tabIndex = 0;
      row.setAttribute("aria-selected", String(fleet[i].robot === chosen));
      row.addEventListener("click", () => choose(fleet[i].robot));
      row.addEventListener("keydown", event => { if (event.key === "Enter") choose(fleet[i].robot); });
    });
    holder.replaceChildren(made);
    const again = focused && [...made.tBodies[0].rows].find(row => row.dataset.robot === focused);
    if (again) again.focus({preventScroll: true});
  }};
}
