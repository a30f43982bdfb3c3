// In the order of the questions: what is it, how far does it close, what else could it be, what to
// do next, what is different elsewhere, where does it lie, what would have been seen.
#include "app/report/diagnosis_report.h"

#include <algorithm>
#include <cmath>

#include "app/report/format.h"
#include "app/report/gap_words.h"

namespace selfcal {
namespace {

constexpr const char* kStyle = R"(
body{font:16px/1.45 system-ui,sans-serif;max-width:54rem;margin:2rem auto;padding:0 1rem;color:#1b1f24}
h1{font-size:1.5rem;margin:0 0 .3rem}h2{font-size:1.1rem;margin:2rem 0 .4rem}
.why{font-size:1.15rem;background:#eef3f8;border-left:5px solid #2b6cb0;padding:.7rem 1rem}
table{border-collapse:collapse;width:100%}td,th{padding:.2rem .6rem .2rem 0;text-align:left;vertical-align:top}
th{font-weight:600;color:#57606a;border-bottom:1px solid #d0d7de}
h3{font-size:1rem;margin:1rem 0 .2rem}
.bar{display:inline-block;height:.8rem;background:#2b6cb0;border-radius:2px;vertical-align:middle}
.muted{color:#57606a}.num{font-variant-numeric:tabular-nums;white-space:nowrap}
)";

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text)
    out += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  return out;
}

std::string escaped_list(const std::vector<std::string>& list) {
  std::string text;
  for (const std::string& each : list) text += (text.empty() ? "" : ", ") + each;
  return escaped(text);
}

/// A bar of up to `most` rem.
std::string bar(double share, double most = 18) {
  return printed("<span class=bar style=\"width:%.2frem\"></span>",
                 most * std::clamp(share, 0.0, 1.0));
}

std::string gap_table(const Diagnosis& diagnosis) {
  const Gap& gap = diagnosis.gap;
  if (gap.rows == 0) return "<p>No rows are kept aside: how far the gap closes was not judged.</p>";
  const double most =
      std::max({gap.rms_before, gap.rms_after, gap.rms_all, gap.noise_floor, 1e-12});
  std::string text = "<table>";
  const auto row = [&](const std::string& what, double value) {
    text += "<tr><td>" + escaped(what) + printed("<td class=num>%.4g mm<td>", 1e3 * value) +
            bar(value / most);
  };
  row("calibrated, geometry alone", gap.rms_before);
  if (const std::string named = named_in_words(diagnosis); !named.empty())
    row("with " + named, gap.rms_after);
  if (const std::string found = found_in_words(diagnosis); !found.empty())
    row("with " + found, gap.rms_all);
  row("noise", gap.noise_floor);
  text += "</table>";
  text += printed(
      "<p class=muted>rms on %d rows that neither the fit nor the choice has seen; %.4g mm with "
      "the "
      "maker's figures.",
      gap.rows, 1e3 * gap.rms_nominal);
  if (const std::string closed = closed_in_words(diagnosis); !closed.empty())
    text += " " + closed + ", each with its 95 % interval.";
  if (const std::string left_out = false_rows_in_words(diagnosis); !left_out.empty())
    text += " " + left_out + ".";
  return text + "</p>";
}

std::string cause_table(const std::vector<CauseResult>& causes) {
  std::string text = "<table><tr><th>cause<th>where<th>probability<th>size<th>cannot be told from";
  for (const CauseResult& each : causes) {
    if (each.probability < 0.01) continue;
    text += "<tr><td>" + effect_in_words(each.effect) + "<td>" + escaped_list(each.where) +
            (each.shape.empty() ? "" : " " + each.shape) +
            printed("<td class=num>%.2f ", each.probability) + bar(each.probability, 6) + "<td>";
    if (each.visible > 0) text += printed("%.2g &times; noise", each.visible);
    text += "<td class=muted>" + escaped_list(each.confounded_with);
  }
  return text + "</table>";
}

std::string cause_parameter_table(const std::vector<CauseResult>& causes) {
  std::string rows;
  for (const CauseResult& each : causes)
    for (const NamedValue& p : each.parameters) {
      if (each.probability < 0.5) continue;
      const double size = std::abs(p.value);
      const char* plausible = size > 3 * p.usual_most ? "larger than usual" : "plausible";
      rows +=
          printed("<tr><td>%s<td class=num>%.3g &plusmn; %.1g %s<td class=num>%.1g to %.1g<td>%s",
                  escaped(p.name).c_str(), p.value, p.sigma, p.unit.c_str(), p.usual_least,
                  p.usual_most, plausible);
    }
  if (rows.empty()) return "";
  return "<h2>How large, and is that "
         "plausible?</h2><table><tr><th>parameter<th>value<th>usual<th>" +
         rows + "</table>";
}

template <class List>
std::string share_table(const char* title, const List& list) {
  std::string rows;
  for (const auto& each : list)
    rows += "<tr><td>" + escaped(each.name) +
            printed("<td class=num>%.0f %%<td>", 100 * each.share) + bar(each.share);
  return rows.empty() ? "" : std::string("<h3>") + title + "</h3><table>" + rows + "</table>";
}

std::string where(const Where& where) {
  std::vector<Share> times, regions;
  for (const Interval& each : where.by_time)
    times.push_back({printed("%.0f to %.0f s", each.from, each.to), each.share});
  for (const Region& each : where.by_region)
    regions.push_back({printed("around (%.2f, %.2f, %.2f) m, %.2f m wide", each.centre.x(),
                               each.centre.y(), each.centre.z(), 2 * each.radius),
                       each.share});
  return share_table("by joint", where.by_joint) + share_table("by set", where.by_set) +
         share_table("by time", times) + share_table("by region", regions);
}

std::string limits(const Diagnosis& diagnosis) {
  std::string text = "<table><tr><th>cause<th>where<th>smallest that would have been named";
  for (const Detectable& each : diagnosis.detectable)
    text += "<tr><td>" + effect_in_words(each.effect) + "<td>" + escaped(each.where) +
            printed("<td class=num>%.2g %s", each.smallest, each.unit.c_str());
  text += "</table>";
  if (diagnosis.untestable.empty()) return text;
  text += "<h3>Cannot be tested on these rows</h3><table>";
  for (const Untestable& each : diagnosis.untestable)
    text += "<tr><td>" + effect_in_words(each.effect) + "<td>" + escaped(each.at) + "<td>" +
            escaped(each.why);
  return text + "</table>";
}

std::string next(const Diagnosis& diagnosis) {
  if (diagnosis.next.empty() && diagnosis.next_why.empty()) return "";
  std::string text = "<h2>What to measure next</h2><ul>";
  for (const NextStep& step : diagnosis.next)
    text += "<li>" + escaped(step.what + next_in_words(step));
  return text + "</ul><p class=muted>" + escaped(diagnosis.next_why) + "</p>";
}

/// "1.2e-03 ± 1e-05 rad", for each value on a line of its own.
std::string sizes(const std::vector<NamedValue>& values) {
  std::string text;
  for (const NamedValue& each : values)
    text += (text.empty() ? "" : "<br>") +
            (values.size() > 1 ? escaped(each.name) + " " : std::string()) +
            printed("%.3g &plusmn; %.1g %s", each.value, each.sigma, each.unit.c_str());
  return text;
}

std::string change_table(const std::vector<Change>& changes) {
  if (changes.empty()) return "";
  std::string text = "<table><tr><th>change<th>where<th>probability<th>size";
  for (const Change& each : changes)
    text += "<tr><td>" + effect_in_words(each.effect) + "<td>" + escaped(each.where) +
            printed("<td class=num>%.2f ", each.probability) + bar(each.probability, 6) +
            "<td class=num>" + sizes(each.values);
  return text + "</table>";
}

std::string changed(const SinceBefore& since) {
  return "<h2>What changed since " + escaped(since.name) + "</h2><p>" +
         escaped(since.comparison.why) + "</p>" + change_table(since.comparison.changes);
}

std::string shown_table(const char* title, const std::vector<ShownCause>& causes) {
  if (causes.empty()) return "";
  std::string text = std::string("<h3>") + title +
                     "</h3><table><tr><th>cause<th>where<th>probability<th>size<th>cannot be told "
                     "from";
  for (const ShownCause& each : causes)
    text += "<tr><td>" + effect_in_words(each.effect) + "<td>" + escaped(each.where) +
            printed("<td class=num>%.2f ", each.probability) + bar(each.probability, 6) +
            "<td class=num>" + sizes(each.parameters) + "<td class=muted>" +
            escaped_list(each.confounded_with);
  return text + "</table>";
}

std::string shared_table(const std::vector<SharedCause>& causes) {
  if (causes.empty()) return "";
  std::string text =
      "<h3>In both</h3><table><tr><th>cause<th>where<th>robot<th>simulation<th>apart";
  for (const SharedCause& each : causes) {
    text +=
        "<tr><td>" + effect_in_words(each.effect) + "<td>" + escaped(each.where) + "<td><td><td>";
    for (const SideBySide& p : each.parameters)
      text += "<tr><td class=muted>" + escaped(p.robot.name) + "<td><td class=num>" +
              sizes({p.robot}) + "<td class=num>" + sizes({p.simulation}) +
              printed("<td class=num>%.1f sigma", p.sigmas);
  }
  return text + "</table>";
}

std::string differs(const AgainstSimulation& sim) {
  const Differences& of = sim.differences;
  std::string text = "<h2>Against the simulation " + escaped(sim.name) + "</h2><ul>";
  for (const std::string& each : of.sentences) text += "<li>" + escaped(each);
  text += "</ul>" + shown_table("In the robot alone", of.robot_only) +
          shown_table("In the simulation alone", of.simulation_only) + shared_table(of.both);
  const std::string geometry = change_table(of.geometry.changes);
  return geometry.empty() ? text
                          : text + "<h3>In the geometry: robot less simulation</h3>" + geometry;
}

}  // namespace

std::string html_report(const Findings& findings) {
  const Diagnosis& diagnosis = findings.diagnosis;
  const std::string& name = findings.name;
  std::string text = "<!doctype html><html lang=en><meta charset=utf-8><title>Diagnosis of " +
                     escaped(name) + "</title><style>" + kStyle + "</style>";
  text += "<h1>" + escaped(name) + "</h1><p class=why>" + escaped(diagnosis.why) + "</p>";
  text += "<h2>How far the gap closes</h2>" + gap_table(diagnosis);
  text += "<h2>What causes it</h2>" + cause_table(diagnosis.candidates);
  text += cause_parameter_table(diagnosis.candidates) + next(diagnosis);
  if (findings.since) text += changed(*findings.since);
  if (findings.sim) text += differs(*findings.sim);
  text += "<h2>Where what calibration leaves lies</h2>" + where(diagnosis.where);
  text += "<h2>What would have been seen</h2>" + limits(diagnosis);
  if (!diagnosis.rejected.empty()) {
    text += "<h2>Rows put aside</h2><p>";
    for (const Outlier& each : diagnosis.rejected)
      text += printed("%d (%s), ", each.row, escaped(each.set).c_str());
    text.resize(text.size() - 2);
    text += "</p>";
  }
  for (const std::string& warning : diagnosis.warnings)
    text += "<p class=muted>" + escaped(warning) + "</p>";
  return text + "</html>\n";
}

}  // namespace selfcal
