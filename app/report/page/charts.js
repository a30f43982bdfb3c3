// Charts, drawn by Chart.js in the page's colours; drawn again when light turns dark, and in light for
// the printer.

const drawn = [];

function colour(name) { return getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim(); }

function faded(hex, alpha) {
  return hex + Math.round(255 * alpha).toString(16).padStart(2, "0");
}

// `make` returns the chart's configuration in the present colours.
function chart(make, caption = "", kind = "", height = 0) {
  const canvas = element("canvas", {role: "img", "aria-label": caption});
  const box = element("div", {class: "chart " + kind}, canvas);
  if (height) box.style.height = height + "rem";
  drawn.push({canvas, make, chart: null});
  return element("figure", {}, box, caption ? element("figcaption", {}, caption) : null);
}

function draw_charts() {
  Chart.defaults.color = colour("soft");
  Chart.defaults.borderColor = colour("line");
  Chart.defaults.animation = false;
  Chart.defaults.maintainAspectRatio = false;
  Chart.defaults.font.family = getComputedStyle(document.body).fontFamily;
  for (const each of drawn) {
    if (each.chart) each.chart.destroy();
    each.chart = new Chart(each.canvas, each.make());
  }
}

function axis(title, more = {}) {
  return Object.assign({title: {display: title !== "", text: title}, grid: {color: colour("line")}}, more);
}

// Log axes are labelled at 1, 2 and 5 of each decade.
function decade_tick(value) {
  const digit = value / Math.pow(10, Math.floor(Math.log10(value) + 1e-9));
  return [1, 2, 5].some(each => Math.abs(digit - each) < 1e-6) ? figure(value, 2) : "";
}

function dots(points, label, name, more = {}) {
  return Object.assign({label, data: points, pointRadius: 2.5, pointHoverRadius: 5, borderColor: colour(name),
                        backgroundColor: faded(colour(name), 0.55)}, more);
}

function scatter(series, x, y, more = {}) {
  return {
    type: "scatter", data: {datasets: series},
    options: {
      scales: {x: axis(x, more.x), y: axis(y, more.y)},
      plugins: {
        legend: {display: series.length > 1, labels: {boxWidth: 12, usePointStyle: true}},
        tooltip: {callbacks: {label: item => (item.raw.name || item.dataset.label) + ": " + figure(item.raw.y, 4)}},
      },
    },
  };
}

// Counts of lists of numbers (> 0) in classes of equal ratio.
function log_histogram(lists, unit) {
  const all = lists.flatMap(list => list.values).filter(value => value > 0);
  if (all.length === 0) return null;
  const per_decade = 6;
  const class_of = value => Math.floor(per_decade * Math.log10(Math.max(value, floor)) + 1e-9);
  const sorted = all.slice().sort((a, b) => a - b);
  const floor = Math.max(sorted[0], sorted[sorted.length - 1] * 1e-5);
  const first = class_of(floor), last = class_of(sorted[sorted.length - 1]);
  const edges = [...Array(last - first + 2).keys()].map(i => Math.pow(10, (first + i) / per_decade));
  const counts = lists.map(list => {
    const bins = Array(last - first + 1).fill(0);
    for (const value of list.values) bins[class_of(value) - first] += 1;
    return bins;
  });
  return () => ({
    type: "bar",
    data: {
      labels: edges.slice(0, -1).map((edge, i) => figure(edge, 2) + " to " + figure(edges[i + 1], 2)),
      datasets: lists.map((list, i) => ({
        label: list.label, data: counts[i], backgroundColor: faded(colour(list.colour), 0.7),
        borderColor: colour(list.colour), borderWidth: 1, categoryPercentage: 1, barPercentage: 0.95, grouped: false,
      })),
    },
    options: {
      scales: {x: axis("residual, " + unit, {ticks: {callback: (_, i) => figure(edges[i], 2), maxRotation: 0}}),
               y: axis("rows", {ticks: {precision: 0}})},
      plugins: {legend: {labels: {boxWidth: 12}}},
    },
  });
}

// Intervals as bars lying beside each other, with their middle. items: {label, from, to, at}.
function intervals(items, unit, name = "after") {
  return () => ({
    type: "bar",
    data: {
      labels: items.map(item => item.label),
      datasets: [
        {label: "95 % interval", data: items.map(item => [item.from, item.to]), indexAxis: "y", order: 2,
         backgroundColor: faded(colour(name), 0.4), borderColor: colour(name), borderWidth: 1, borderSkipped: false,
         barThickness: 9},
        {label: "change", data: items.map(item => item.at), type: "line", showLine: false, indexAxis: "y", order: 1,
         pointRadius: 3.5, pointBackgroundColor: colour("ink"), pointBorderColor: colour("ink"),
         backgroundColor: colour("ink")},
      ],
    },
    options: {
      indexAxis: "y",
      scales: {x: axis(unit), y: axis("", {grid: {display: false}, ticks: {autoSkip: false}})},
      plugins: {legend: {display: false}, tooltip: {callbacks: {label: item => Array.isArray(item.raw)
        ? item.raw.map(value => figure(value, 4)).join(" to ") + " " + unit : figure(item.raw, 4) + " " + unit}}},
    },
  });
}

// Bars lying beside their labels. items: {label, value}.
function bars(items, title, name = "after", most = undefined) {
  return () => ({
    type: "bar",
    data: {labels: items.map(item => item.label),
           datasets: [{data: items.map(item => item.value), backgroundColor: items.map(item =>
             faded(colour(item.colour || name), 0.75)), maxBarThickness: 20}]},
    options: {
      indexAxis: "y",
      scales: {x: axis(title, {min: 0, max: most}), y: axis("", {grid: {display: false}, ticks: {autoSkip: false}})},
      plugins: {legend: {display: false}, tooltip: {callbacks: {label: item => figure(item.raw, 4)}}},
    },
  });
}

// A label that fits beside its bar on a phone, as lines.
function wrapped(text, width = 24) {
  const lines = [""];
  for (const word of text.split(" ")) {
    if (lines[lines.length - 1].length + word.length > width && lines[lines.length - 1]) lines.push("");
    lines[lines.length - 1] += (lines[lines.length - 1] ? " " : "") + word;
  }
  return lines;
}
