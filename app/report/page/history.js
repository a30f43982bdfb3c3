// A robot's history, section by section.

const DAY = 86400e3;

// As the tables have it, where one looks.
function date_of(unix_ms) {
  const day = new Date(unix_ms);
  return [day.getFullYear(), day.getMonth() + 1, day.getDate()].map(part => String(part).padStart(2, "0")).join("-");
}

// Points with intervals over time. points: {x (ms), y, low, high}; limits are drawn as dashed lines.
function over_time(points, unit, limits = [], kind = "small") {
  const bounded = points.filter(point => known(point.low));
  const first = points[0].x, last = points[points.length - 1].x, pad = Math.max(0.05 * (last - first), DAY);
  return chart(() => {
    const series = [dots(points, unit, "after", {showLine: true, pointRadius: 4, borderWidth: 1.5})];
    for (const point of bounded)
      series.push({data: [{x: point.x, y: point.low}, {x: point.x, y: point.high}], showLine: true, pointStyle: "line",
                   pointRadius: 4, borderColor: colour("after"), borderWidth: 1.5, label: "95 % interval"});
    const from = first - pad, to = last + pad;
    for (const limit of limits)
      series.push({data: [{x: from, y: limit}, {x: to, y: limit}], showLine: true, pointRadius: 0,
                   borderColor: colour("bad"), borderDash: [6, 4], borderWidth: 1.5, label: "limit"});
    const configured = scatter(series, "", unit, {x: {min: from, max: to,
                                                       ticks: {callback: date_of, maxTicksLimit: 3, maxRotation: 0}}});
    configured.options.plugins.legend.display = false;
    configured.options.plugins.tooltip.callbacks.title = items => date_of(items[0].raw.x);
    return configured;
  }, "", kind);
}

// Of the changes that are known, the largest: what the unit's prefix goes by.
function largest_of(drift) {
  return Math.max(...[...drift.since_factory, ...drift.sigma].filter(known).map(Math.abs));
}

function rate_words(drift) {
  const trend = drift.trend;
  if (!trend) return "";
  const [factor, word] = shown(drift.unit, largest_of(drift));
  const rate = figure(30 * factor * trend.rate) + " ± " + figure(30 * 1.96 * factor * trend.rate_sigma, 2) + " " +
    word + " a month";
  if (trend.outside) return rate + "; beyond its limit now";
  return rate + (known(trend.leaves_in_days) ? "; leaves its limit in " + figure(trend.leaves_in_days, 2) + " days" : "");
}

function drift_figure(data, drift) {
  const [factor, unit] = shown(drift.unit, largest_of(drift));
  const points = drift.since_factory.map((value, i) => {
    const sigma = drift.sigma[i];
    return {x: data.calibrations[i].unix_ms, y: factor * value, name: "session " + data.calibrations[i].session,
            low: known(sigma) ? factor * (value - 1.96 * sigma) : null,
            high: known(sigma) ? factor * (value + 1.96 * sigma) : null};
  });
  const near = Math.max(...points.map(point => Math.abs(point.y))) > 0.5 * factor * drift.limit;
  const words = rate_words(drift);
  const made = over_time(points, unit, near ? [-factor * drift.limit, factor * drift.limit] : []);
  made.prepend(element("h3", {}, drift.name));
  if (words) made.append(element("figcaption", {}, words));
  return made;
}

function drift_section(data) {
  const most = 12, drifts = data.drifts;
  if (drifts.length === 0) return [];
  const last = drifts.map(drift => drift.since_factory.length - 1)[0];
  const rows = drifts.map(drift => {
    const [factor, unit] = shown(drift.unit, largest_of(drift)), sigma = drift.sigma[last];
    const places = decimals(known(sigma) ? 1.96 * factor * sigma : 0);
    return [drift.name, fixed(factor * drift.since_factory[last], places) +
      (known(sigma) ? " ± " + fixed(1.96 * factor * sigma, places) : "") + " " + unit,
      "± " + figure(factor * drift.limit) + " " + unit, rate_words(drift)];
  });
  return [
    paragraph("Change since the factory, with its 95 % interval; those that moved most between sessions first, surest of all by more than their sigma. The limit " +
              "is three of the maker's tolerances.", "soft"),
    element("div", {class: "multiples"}, drifts.slice(0, most).map(drift => drift_figure(data, drift))),
    folded("every parameter that moved", table([{title: "parameter"}, {title: "now, 95 % interval", number: true},
      {title: "limit", number: true}, {title: "rate"}], rows)),
  ];
}

function residual_section(data) {
  const residual = data.residual;
  if (residual.points.length === 0) return [];
  const points = residual.points.map(each => ({x: each.unix_ms, y: 1e3 * each.rms, name: "session " + each.session,
    low: known(each.least) ? 1e3 * each.least : null, high: known(each.most) ? 1e3 * each.most : null}));
  const words = rate_words({trend: residual.trend, unit: "m", since_factory: residual.points.map(each => each.rms), sigma: []});
  return [over_time(points, "mm", residual.limit ? [1e3 * residual.limit] : [], ""),
          paragraph("Residual of the quick checks with its 95 % interval" +
                    (residual.limit ? "; the dashed line is the accuracy that is wanted" : "") + "." +
                    (words ? " " + words[0].toUpperCase() + words.slice(1) + "." : ""), "soft")];
}

function show_history(data) {
  section("Check residual", residual_section(data));
  section("Drift", drift_section(data));
  section("Sessions", table([{title: "session"}, {title: "when"}, {title: "kind"}, {title: "answer"},
    {title: "decision"}, {title: "before, mm", number: true}, {title: "after, mm", number: true},
    {title: "end position, mm", number: true}, {title: "touches", number: true}],
    data.sessions.map(each => {
      const r = each.result, full = each.kind !== "check";
      return [String(each.session), each.when, each.kind, r ? r.answer : each.state, r ? r.decision : "",
              r ? mm(r.check_before) : "", r ? mm(r.check_after) : "", r && full ? mm(r.endpoint_sigma) : "",
              r ? String(r.touches) : ""];
    })));
  section("Events", table([{title: "when", whole: true}, {title: "level", whole: true}, {title: "what"}],
                          data.events.map(each => [each.when, each.level, each.text])));
}
