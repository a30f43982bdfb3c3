// A diagnosis, section by section.

function effect_words(effect) { return effect.replace(/_/g, " "); }

function cause_words(cause) {
  if (cause.effect === "unknown") return "something else, none of these";
  if (cause.effect === "none") return "nothing but noise";
  const where = Array.isArray(cause.where) ? cause.where.join(", ") : cause.where;
  return effect_words(cause.effect) + (where ? " at " + where : "");
}

function value_words(value) {
  const [factor, unit] = shown(value.unit, Math.max(Math.abs(value.value), value.sigma));
  return value_figure(factor * value.value, factor * value.sigma) + " ± " + figure(factor * value.sigma, 2) + " " + unit;
}

function values_words(values) {
  return values.map(value => (values.length > 1 ? value.name + " " : "") + value_words(value)).join("; ");
}

// A sentence of the program with effects as words.
function in_words(sentence, effects) {
  const text = effects.reduce((words, effect) => words.split(effect).join(effect_words(effect)), sentence);
  return text.charAt(0).toUpperCase() + text.slice(1);
}

function gap_of(data) {
  const gap = data.result.gap, words = data.words;
  if (gap.rows === 0) return [paragraph("How far the gap closes was not judged; the warnings say why.")];
  const steps = [{label: ["maker's figures"], value: gap.rms_nominal, colour: "soft"},
                 {label: ["calibrated"], value: gap.rms_before, colour: "before"}];
  if (words.named) steps.push({label: ["with what is named"], tile: "with " + words.named, value: gap.rms_after, colour: "after"});
  if (words.found) steps.push({label: ["with all found"], tile: "with " + words.found, value: gap.rms_all, colour: "good"});
  steps.push({label: ["noise"], value: gap.noise_floor, colour: "open"});
  const items = steps.filter(step => known(step.value)).map(step =>
    ({label: step.label, tile: step.tile || step.label[0], value: 1e3 * step.value, colour: step.colour}));
  const parts = [tiles(items.map(item => [figure(item.value, 4) + " mm", item.tile])),
    chart(bars(items, "rms, mm"), "On " + gap.rows + (gap.judged_on === "folds"
      ? " rows, each part judged by the others in turn." : " rows that neither the fit nor the search has seen."),
      "", 3 + 3 * items.length)];
  const intervals = gap.closed_interval || gap.closed_all_interval;
  if (words.closed) parts.push(paragraph(words.closed[0].toUpperCase() + words.closed.slice(1) +
                                         (intervals ? ", with the 95 % interval." : ".")));
  if (words.false_rows) parts.push(paragraph(words.false_rows, "soft"));
  const judged = data.judged;
  const lists = judged ? [["maker's figures", "soft", judged.nominal], ["calibrated", "before", judged.before]] : [];
  if (judged && words.named) lists.push(["with what is named", "after", judged.after]);
  const make = log_histogram(lists.map(([label, name, values]) =>
    ({label, colour: name, values: values.filter(known).map(value => 1e3 * value)})), "mm");
  if (make) parts.push(chart(make, "The same rows by the size of their residual."));
  return parts;
}

function causes_of(data) {
  const likely = data.result.candidates.filter(each => each.probability >= 0.01);
  const named = data.result.verdict.named;
  const closes = cause => named.find(each => each.effect === cause.effect &&
                                             each.where.join() === cause.where.join()) || {};
  const share = value => known(value) ? (value > 1.05 ? "all" : Math.round(100 * value) + " %") : "";
  return [
    chart(bars(likely.map(each => ({label: wrapped(cause_words(each)), value: each.probability,
      colour: named.length && closes(each).effect ? "after" : "soft"})), "probability", "soft", 1),
      "How probable each cause is; what is named stands out. Causes may act together: the figures need not add up to 1.", "", 3.5 + 2 * likely.length),
    table([{title: "cause"}, {title: "probability", number: true}, {title: "size, times the noise", number: true},
           {title: "closes alone", number: true}, {title: "adds to the others", number: true},
           {title: "these rows cannot tell it from"}],
      likely.map(each => [cause_words(each) + (each.shape ? ", " + each.shape : ""), chance(each.probability),
        each.visible > 0 ? figure(each.visible, 2) : "", share(closes(each).closes_alone),
        share(closes(each).closes_beside), each.confounded_with.map(effect_words).join(", ")])),
  ];
}

// Of what is sure of a size, two sigma less; far beyond from three times the usual largest on, as the verdict has it.
function plausibility(size, sigma, most) {
  const sure = size - 2 * sigma;
  if (sure > 3 * most) return "far beyond the usual";
  return sure > most ? "larger than usual" : "plausible";
}

function sizes_of(candidates, named) {
  const told = each => each.probability >= 0.5 || named.some(cause => cause.effect === each.effect);
  const rows = candidates.filter(told).flatMap(each => each.parameters.map(value => {
    const [factor, unit] = shown(value.unit, Math.max(Math.abs(value.value), value.sigma)), [least, most] = value.usual;
    return [value.name, value_words(value), figure(factor * least, 2) + " to " + figure(factor * most, 2) + " " + unit,
            plausibility(Math.abs(value.value), value.sigma, most)];
  }));
  return table([{title: "parameter"}, {title: "value ± 1 sigma", number: true}, {title: "usual", number: true},
                {title: ""}], rows);
}

function next_of(result) {
  const told = step => known(step.probability_after) ? step.separates : step.separates.filter(each => each !== "unknown");
  const rows = result.next.map(step => [step.what, told(step).map(effect_words).join(" or "),
    known(step.probability_after) ? Math.round(100 * step.probability_after) + " %" : ""]);
  return [table([{title: "measure"}, {title: "tells"}, {title: "then sure to", number: true}], rows),
          result.next.length ? paragraph(result.next_why, "soft") : null];
}

function shares_chart(title, shares) {
  const items = shares.filter(each => each.value > 0.005);
  return items.length ? element("div", {}, element("h3", {}, title),
    chart(bars(items.map(each => ({label: wrapped(each.label), value: 100 * each.value})), "share, %"), "", "",
      3.5 + 1.7 * items.length)) : null;
}

function where_of(data) {
  const where = data.result.where;
  const pairs = shares => Object.entries(shares).map(([label, value]) => ({label, value}));
  const regions = where.by_region;
  return [
    shares_chart("By joint", pairs(where.by_joint)), shares_chart("By set", pairs(where.by_set)),
    shares_chart("By time", where.by_time.map(each =>
      ({label: figure(each.from) + " to " + figure(each.to) + " s", value: each.share}))),
    regions.length ? element("div", {}, element("h3", {}, "In the workspace"), view3d({
      picture: data.picture,
      cells: regions.map(each => ({center: each.center, value: 100 * each.share, radius: 0.35 * each.radius})),
      cells_title: "share of what calibration leaves",
      cells_text: value => ["Share: " + figure(value, 2) + " %", figure(value, 2) + " %"],
    })) : null,
  ];
}

function limits_of(result) {
  const rows = result.detectable.map(each => {
    const [factor, unit] = shown(each.unit, each.smallest);
    return [cause_words(each), figure(factor * each.smallest, 2) + " " + unit];
  });
  const smallest = table([{title: "cause"}, {title: "smallest that would have been named", number: true}], rows);
  return [rows.length > 12 ? folded(plural(rows.length, "cause"), smallest) : smallest,
    result.untestable.length ? element("h3", {}, "Cannot be tested on these rows") : null,
    table([{title: "cause"}, {title: "why"}], result.untestable.map(each => [cause_words(each), each.why]))];
}

function changes_table(changes) {
  return table([{title: "change"}, {title: "probability", number: true}, {title: "size", number: true}],
    changes.map(each => [cause_words(each), chance(each.probability), values_words(each.values)]));
}

function shown_causes(title, causes) {
  return causes.length ? [element("h3", {}, title),
    table([{title: "cause"}, {title: "probability", number: true}, {title: "size", number: true},
           {title: "cannot be told from"}],
      causes.map(each => [cause_words(each), chance(each.probability), values_words(each.parameters),
                          each.confounded_with.map(effect_words).join(", ")]))] : [];
}

function simulation_of(sim, sentences) {
  const shared = sim.both.flatMap(cause => cause.parameters.map(p => {
    const [factor, unit] = shown(p.unit, Math.max(Math.abs(p.robot), p.robot_sigma));
    const side = (value, sigma) => value_figure(factor * value, factor * sigma) + " ± " + figure(factor * sigma, 2) + " " + unit;
    return [cause_words(cause) + ": " + p.name, side(p.robot, p.robot_sigma), side(p.simulation, p.simulation_sigma),
            figure(p.sigmas, 2) + " sigma"];
  }));
  return [bullets(sentences), shown_causes("In the robot alone", sim.robot_only),
    shown_causes("In the simulation alone", sim.simulation_only),
    shared.length ? element("h3", {}, "In both") : null,
    table([{title: "parameter"}, {title: "robot", number: true}, {title: "simulation", number: true},
           {title: "apart", number: true}], shared),
    sim.geometry.changes.length ? element("h3", {}, "In the geometry: robot less simulation") : null,
    changes_table(sim.geometry.changes)];
}

function show_diagnosis(data) {
  const result = data.result;
  if (result.warnings.length) section("Warnings", bullets(result.warnings));
  section("How far the gap closes", gap_of(data));
  section("What causes it", causes_of(data));
  section("How large, and is that plausible", sizes_of(result.candidates, result.verdict.named));
  section("What to measure next", next_of(result));
  if (result.since) section("What changed since " + data.since_name, paragraph(result.since.why),
                            changes_table(result.since.changes));
  if (result.sim) section("Against the simulation " + data.sim_name, simulation_of(result.sim, data.words.simulator));
  section("Where what calibration leaves lies", where_of(data));
  section("What would have been seen", limits_of(result));
  if (result.rejected.length) section("Rows put aside", outlier_table(result.rejected));
}
