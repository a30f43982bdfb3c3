// An identification, section by section.

function moved(each) { return Math.abs(each.value - each.nominal) / each.sigma; }

function row_indices(rows, wanted) { return rows.row.map((_, i) => i).filter(i => wanted(i)); }

function before_after_table(result, angle_alone) {
  const unit = angle_alone ? "mrad" : "mm";
  const line = (what, f) => f.rows > 0
    ? [what, String(f.rows), mm(f.rms_before), mm(f.rms_after), mm(f.mean_after), mm(f.max_after)] : null;
  const angles = (what, f) => f.angle && !angle_alone ? [what + ", angles in mrad", String(f.angle.rows), mm(f.angle.rms_before),
    mm(f.angle.rms_after), mm(f.angle.mean_after), mm(f.angle.max_after)] : null;
  const {check, fit} = result.residual;
  const lines = [line("rows kept aside", check), angles("rows kept aside", check), line("rows that identified", fit),
                 angles("rows that identified", fit)];
  const columns = [{title: "residual, " + unit}, {title: "rows", number: true}, {title: "before, rms", number: true},
                   {title: "after, rms", number: true}, {title: "after, mean", number: true},
                   {title: "after, largest", number: true}];
  const by_set = check.by_set.map(set => line(set.name, set)).filter(Boolean);
  return [table(columns, lines.filter(Boolean)),
          by_set.length > 1 ? folded("rows kept aside, set by set", table(columns, by_set)) : null];
}

// What a person may take for the same: the parameters that a service used, and the maker's.
function before_words(session, unit) {
  const used = session && session.in_use;
  return "Before: the maker's figures, base and tool placed by these rows." +
    (used && known(used.before) && known(used.after)
      ? " The parameters that were in use then, base and tool where they were, missed the touches kept aside by " +
        mm(used.before) + " " + unit + ", as the history has it." : "");
}

function shown_rows_text(rows) {
  return rows.row.length < rows.of
    ? " " + rows.row.length + " of " + rows.of + " rows are shown, evenly chosen." : "";
}

function histogram_of(rows, unit, lengths) {
  const judge = rows.check.some((check, i) => check && lengths(i));
  const used = row_indices(rows, i => lengths(i) && (!judge || rows.check[i]) && known(rows.after[i]));
  const make = log_histogram([
    {label: "before", colour: "before", values: used.map(i => 1e3 * rows.before[i])},
    {label: "after", colour: "after", values: used.map(i => 1e3 * rows.after[i])}], unit);
  return make ? chart(make, (judge ? "Rows kept aside" : "Rows that identified (none are kept aside)") +
    " by the size of their residual at the tool." + shown_rows_text(rows)) : null;
}

function workspace_view(data) {
  const grid = data.result.uncertainty ? data.result.uncertainty.grid.filter(cell => known(cell.sigma)) : [];
  return view3d({
    picture: data.picture, rows: data.rows,
    cells: grid.map(cell => ({center: cell.center, value: cell.sigma})),
    cells_title: "how well the end position is known",
    cells_text: value => ["1 sigma of the end position: " + mm(value, 2) + " mm", mm(value, 2) + " mm"],
  });
}

// Residuals after against anything that a row knows; x(i) is null where it knows nothing.
function against(rows, used, x, title, unit, kind = "small", both = false) {
  const points = (wanted, column) => used.filter(i => wanted(i) && x(i) !== null && known(column[i])).map(i =>
    ({x: x(i), y: 1e3 * column[i], name: "row " + rows.row[i]}));
  const fit = points(i => !rows.check[i] && !rows.rejected[i], rows.after);
  const check = points(i => rows.check[i] && !rows.rejected[i], rows.after);
  const aside = points(i => rows.rejected[i], rows.after);
  if (fit.length + check.length + aside.length === 0) return null;
  return chart(() => {
    const series = [];
    if (both) series.push(dots(points(() => true, rows.before), "before", "before", {pointRadius: 2}));
    if (fit.length) series.push(dots(fit, "after, identified", "after"));
    if (check.length) series.push(dots(check, "after, kept aside", "good", {pointStyle: "triangle"}));
    if (aside.length) series.push(dots(aside, "beyond the noise", "bad", {pointStyle: "crossRot", pointRadius: 5,
                                                                          borderWidth: 2}));
    const configured = scatter(series, title, unit, {y: {type: "logarithmic", ticks: {callback: decade_tick}}});
    configured.options.plugins.legend.display = both;
    return configured;
  }, "", kind);
}

function residual_charts(data, unit, lengths) {
  const rows = data.rows, used = row_indices(rows, lengths);
  const joints = data.robot.joints;
  const every = [];
  joints.forEach((joint, j) => {
    const degrees = joint.unit === "rad";
    every.push(against(rows, used, i => known(rows.q[i][j]) ? (degrees ? 180 / Math.PI : 1e3) * rows.q[i][j] : null,
                       joint.name + (degrees ? ", degrees" : ", mm"), unit));
  });
  const others = [];
  const varies = column => new Set(column.filter(known)).size > 1;
  if (rows.load && varies(rows.load))
    others.push(against(rows, used, i => known(rows.load[i]) ? rows.load[i] : null, "load, N", unit));
  if (rows.temperature && varies(rows.temperature))
    others.push(against(rows, used, i => known(rows.temperature[i]) ? rows.temperature[i] : null,
                        "temperature, °C", unit));
  if (rows.dq)
    joints.forEach((joint, j) => {
      const signs = rows.dq.map(dq => known(dq[j]) ? Math.sign(dq[j]) : null);
      if (varies(signs)) others.push(approach_chart(rows, used, signs, joint.name, unit));
    });
  return [
    against(rows, used, i => rows.row[i], "row", unit, "", true),
    element("h3", {}, "Against each joint"), element("div", {class: "multiples"}, every),
    others.length ? element("h3", {}, "Against load, warmth and the way of approach") : null,
    others.length ? element("div", {class: "multiples"}, others) : null,
  ];
}

// The rms of what is left after of rows that came in with the joint falling, at rest and rising.
function approach_chart(rows, used, signs, name, unit) {
  const groups = [[-1, "falling"], [0, "at rest"], [1, "rising"]].map(([sign, label]) => {
    const values = used.filter(i => signs[i] === sign && !rows.rejected[i] && known(rows.after[i])).map(i =>
      1e3 * rows.after[i]);
    return {label: label + " (" + values.length + ")", values};
  }).filter(group => group.values.length);
  const items = groups.map(group => ({label: group.label,
    value: Math.sqrt(group.values.reduce((sum, value) => sum + value * value, 0) / group.values.length)}));
  return chart(bars(items, name + ": rms after, " + unit), "", "small");
}

const STATUS_WORDS = {
  "no-effect": "Without effect on these rows",
  fixed: "Held as asked, or by default",
};

function parameter_rows(list, names, k) {
  return list.map(each => {
    const [factor, unit] = shown(each.unit, Math.max(Math.abs(each.value), each.sigma));
    const change = factor * (each.value - each.nominal), half = k * factor * each.sigma, places = decimals(half);
    // A ratio's own value is no ppm: only what it is off by.
    const ratio = each.unit === "1" && Math.abs(each.nominal) > 0.01;
    const whole = value => ratio ? figure(value, 8) : figure(factor * value, 6) + " " + unit;
    return [names[each.name], fixed(change, places) + " ± " + fixed(half, places) + " " + unit,
            moved(each).toFixed(1) + " sigma", whole(each.nominal), whole(each.value)];
  });
}

function parameter_table(list, names, k) {
  return table([{title: "parameter"}, {title: "change, 95 % interval", number: true},
                {title: "significance", number: true}, {title: "maker's figure", number: true},
                {title: "identified", number: true}], parameter_rows(list, names, k));
}

function parameter_chart(list, names, k, unit, title) {
  const of_unit = list.filter(each => each.unit === unit);
  if (of_unit.length === 0) return null;
  const [factor, word] = shown(unit);
  const items = of_unit.map(each => {
    const at = factor * (each.value - each.nominal), half = k * factor * each.sigma;
    return {label: names[each.name], from: at - half, to: at + half, at};
  });
  return element("div", {}, element("h3", {}, title),
    chart(intervals(items, "change, " + word), "", "", 4 + 1.35 * items.length));
}

function notes(title, list, word) {
  const by_reason = new Map();
  for (const each of list) by_reason.set(each[word], [...(by_reason.get(each[word]) || []), each.parameter]);
  return by_reason.size ? [element("h3", {}, title), table([{title: "parameter"}, {title: "why"}],
    [...by_reason].map(([why, names]) => [names.join(", "), why]))] : [];
}

function parameters_of(data) {
  const result = data.result, names = data.full_names;
  const k = result.uncertainty ? result.uncertainty.k95 : 1.96;
  const told = result.parameters.filter(each => each.status === "identified" && each.sigma > 0);
  const sure = told.filter(each => moved(each) > 1).sort((a, b) => moved(b) - moved(a));
  const rest = told.filter(each => moved(each) <= 1);
  const grouped = result.parameters.filter(each => each.status === "grouped");
  const parts = [];
  if (sure.length)
    parts.push(paragraph(plural(sure.length, "parameter") + " moved by more than " +
                         (sure.length === 1 ? "its" : "their") + " sigma, surest first.", "soft"),
      parameter_chart(sure, names, k, "m", "Lengths that moved"),
      parameter_chart(sure, names, k, "rad", "Angles that moved"), parameter_table(sure, names, k));
  if (rest.length)
    parts.push(folded(plural(rest.length, "parameter") + " moved by less than " +
                      (rest.length === 1 ? "its" : "their") + " sigma: no change that one may rely on",
                      parameter_table(rest, names, k)));
  parts.push(...notes("Held, and why", result.gauge, "why"));
  parts.push(...notes("Not told by these rows, and what would help", result.unexcited, "what"));
  if (grouped.length)
    parts.push(element("h3", {}, "Known only together with others"),
      paragraph("These rows see a combination of them; the change is booked on the parameter beside.", "soft"),
      folded(plural(grouped.length, "parameter"), table([{title: "parameter"}, {title: "together with"}],
        grouped.map(each => [names[each.name], each.grouped_with.length
          ? each.grouped_with.map(other => names[other.name] || other.name).join(", ") : "other parameters"]))));
  for (const status of ["no-effect", "fixed"]) {
    const list = result.parameters.filter(each => each.status === status);
    if (list.length) parts.push(element("h3", {}, STATUS_WORDS[status]),
                                paragraph(list.map(each => names[each.name]).join(", ")));
  }
  return parts;
}

function residual_words(u) {
  const words = [];
  const r = u.residuals, fit = u.lack_of_fit;
  if (known(fit.p_value)) {
    const ratio = "F = " + figure(fit.F) + " of " + figure(fit.freedoms) + " and " + figure(fit.repeat_freedoms) +
      " freedoms, p " + probability(fit.p_value);
    words.push(fit.p_value < 0.05
      ? "The model leaves more than repeats of the same pose scatter (" + ratio +
        "): something that it does not describe is at work; selfcal diagnose tells what."
      : "What is left is no more than repeats of the same pose scatter (" + ratio + ").");
  }
  if (known(r.normality_p))
    words.push(r.normality_p < 0.05
      ? "What is left is not spread as normal noise is (p " + probability(r.normality_p) + ")."
      : "What is left is spread as normal noise is (p " + probability(r.normality_p) + ").");
  if (known(r.autocorrelation_p))
    words.push(r.autocorrelation_p < 0.05
      ? "Rows beside each other miss alike (correlation " + figure(r.autocorrelation, 2) + ", p " +
        probability(r.autocorrelation_p) + "): something drifts, or neighbouring poses share an error."
      : "Rows beside each other miss independently (p " + probability(r.autocorrelation_p) + ").");
  return bullets(words);
}

// Parameters of which the rows tell the sum or the difference, and each alone the less.
function correlation_table(u, names) {
  const pairs = [...u.correlations].sort((a, b) => Math.abs(b.value) - Math.abs(a.value));
  return pairs.length ? folded("Parameters that these rows hardly tell apart (" + pairs.length + ")",
    table([{title: "parameter"}, {title: "goes with"}, {title: "correlation", number: true}],
      pairs.map(each => [names[each.a] || each.a, names[each.b] || each.b, fixed(each.value, 3)]))) : null;
}

function region_table(u) {
  const cells = u.grid.filter(cell => known(cell.sigma));
  return cells.length ? folded("How well the end position is known, by region (" + cells.length + ")",
    table([{title: "about x, y, z, m", number: true}, {title: "1 sigma, mm", number: true},
           {title: "expected bias, mm", number: true}, {title: "rows there", number: true}],
      cells.map(cell => [cell.center.map(each => fixed(each, 2)).join(", "), mm(cell.sigma), mm(cell.bias),
                         String(cell.rows)]))) : null;
}

function uncertainty_of(data) {
  const result = data.result, u = result.uncertainty, endpoint = result.endpoint_sigma;
  const parts = [];
  const work = endpoint.workspace;
  parts.push(tiles([
    [known(work.rms) ? mm(work.rms) + " mm" : null, "end position in the workspace, 1 sigma"],
    [u ? "± " + mm(u.expanded) + " mm" : null, u ? "95 % (k = " + figure(u.k95) + (known(u.freedoms) ? ", " + figure(u.freedoms) + " freedoms)" : ")") : ""],
    [mm(data.data.target) + " mm", "wanted, 1 sigma"],
    [known(work.angle_rms) ? mm(work.angle_rms) + " mrad" : null, "how it is turned, 1 sigma"],
    [known(endpoint.rms) ? mm(endpoint.rms) + " mm" : null, "over the whole range of the joints, 1 sigma"],
    [u && u.repeats.poses ? mm(u.repeats.accuracy) + " / " + mm(u.repeats.repeatability) + " mm" : null,
     "accuracy / repeatability of the worst repeated pose, after"]]));
  if (u) {
    const lines = u.budget.filter(each => each.sigma > 0).sort((a, b) => b.sigma - a.sigma);
    if (lines.length)
      parts.push(chart(bars(lines.map(each => ({label: wrapped(each.source), value: 1e3 * each.sigma})), "1 sigma, mm"),
        "What the doubt of the end position is made of; the squares add up.", "", 4 + 2.4 * lines.length));
    parts.push(residual_words(u), correlation_table(u, data.full_names), region_table(u));
  }
  const scale = result.scale.stands_on;
  if (scale.length)
    parts.push(element("h3", {}, "What the robot's size stands on"),
      table([{title: "length given"}, {title: "value, mm", number: true}, {title: "expected, mm", number: true},
             {title: "0.1 mm of it moves the end by", number: true}],
        scale.map(each => [each.what + " of set " + each.set, mm(each.value, 7),
          mm(each.expected, 7) + (known(each.expected_sigma) ? " ± " + mm(each.expected_sigma, 2) : ""),
          mm(each.per_tenth_mm) + " mm"])));
  return parts;
}

function outlier_table(list) {
  const most = 60;
  const sized = list.some(each => each.residual > 0);
  const rows = list.slice(0, most).map(each => [String(each.row), each.set,
    each.part === "check" ? "kept aside" : "identifies", ...(sized ? [known(each.residual) ? mm(each.residual) : ""] : []),
    each.why]);
  return [table([{title: "row", number: true}, {title: "set"}, {title: "part"},
                 ...(sized ? [{title: "residual, mm or mrad", number: true}] : []), {title: "why"}], rows),
          list.length > most ? paragraph("and " + (list.length - most) + " more (result.json names them)", "soft") : null];
}

function show_identification(data) {
  const result = data.result, rows = data.rows;
  const angle_alone = !rows || rows.angle_alone.every(Boolean);
  const unit = angle_alone ? "mrad" : "mm";
  const lengths = i => angle_alone || !rows.angle_alone[i];
  if (result.warnings.length) section("Warnings", bullets(result.warnings));
  if (!rows) return;
  section("Before and after", histogram_of(rows, unit, lengths),
          before_after_table(result, angle_alone), paragraph(before_words(data.session, unit), "soft"));
  section("In the workspace", workspace_view(data));
  section("What moved", parameters_of(data));
  section("How sure", uncertainty_of(data));
  section("Residuals row by row", paragraph("In " + unit + ", on a logarithmic scale: a trend is something that the " +
    "model does not describe." + shown_rows_text(rows), "soft"), residual_charts(data, unit, lengths));
  if (result.rejected.length) section("Rows beyond the noise", outlier_table(result.rejected));
}
