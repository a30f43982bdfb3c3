// Names, priors and the order of preference of a serial robot's parameters.
//
// The order decides which member of a dependent group is identified (Khalil and Dombre, 11.4.2.1):
// what a controller can take over directly comes first. Within the link lengths the longest comes
// last: it is the one held when the rows leave the scale free, where its tolerance costs least.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinematics/robots/serial.h"

namespace selfcal::serial {
namespace {

constexpr const char* kNames[kFields] = {"alpha", "d", "theta", "r", "beta"};
constexpr double kLinkTolerance = 2.0e-3;   // m or rad
constexpr double kPlacedTolerance = 50e-3;  // base and tool frames: m or rad
constexpr double kGearTolerance = 1.0e-4;

int index(int frame, int field) { return kFields * frame + field; }

bool is_angle(int field) { return field == kAlpha || field == kTheta || field == kBeta; }

bool is_quarter_turn(double angle) {
  const double quarters = angle / (std::numbers::pi / 2);
  return std::abs(quarters - std::round(quarters)) < 1e-6;
}

/// First and last moving frame.
struct Span {
  int first, last;
};
Span moving_span(const Model& model) {
  const std::vector<int> moving = moving_frames(model);
  return {moving.front(), moving.back()};
}

bool is_link_length(const Model& model, Span span, int f, int field) {
  if (is_angle(field) || f <= span.first || f > span.last) return false;
  if (f == span.last && field == kR) return false;
  if (model.frames[f].motion == Motion::prismatic && field == kR) return false;
  return model.frames[f].nominal[field] != 0;
}

/// Appends columns, each only once.
class Order {
 public:
  explicit Order(size_t count) : taken_(count, false) {}
  void add(int column) {
    if (taken_[column]) return;
    taken_[column] = true;
    columns_.push_back(column);
  }
  std::vector<int> columns_;

 private:
  std::vector<bool> taken_;
};

void add_links(const Model& model, Span span, Order& order) {
  std::vector<std::pair<double, int>> lengths;
  for (int f = span.first + 1; f <= span.last; ++f)
    for (const int field : {kD, kR})
      if (is_link_length(model, span, f, field))
        lengths.emplace_back(std::abs(model.frames[f].nominal[field]), index(f, field));
  std::stable_sort(lengths.begin(), lengths.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [length, column] : lengths) order.add(column);
  for (int f = span.first + 1; f <= span.last; ++f)
    for (const int field : {kAlpha, kTheta})
      if (!is_quarter_turn(model.frames[f].nominal[field])) order.add(index(f, field));
}

void add_base(Span span, Order& order) {
  for (int f = span.first; f > 0; --f) order.add(index(f, kAlpha));
  for (int f = span.first - 1; f >= 0; --f) {
    order.add(index(f, kR));
    order.add(index(f, kTheta));
  }
  for (int f = span.first; f > 0; --f) order.add(index(f, kD));
  order.add(index(span.first, kTheta));
  order.add(index(span.first, kR));
}

void add_tool(Span span, int frames, Order& order) {
  for (int f = span.last + 1; f < frames; ++f) order.add(index(f, kD));
  order.add(index(span.last, kR));
  for (const int field : {kAlpha, kTheta, kR})
    for (int f = span.last + 1; f < frames; ++f) order.add(index(f, field));
}

}  // namespace

std::vector<int> moving_frames(const Model& model) {
  std::vector<int> moving;
  for (size_t f = 0; f < model.frames.size(); ++f)
    if (model.frames[f].motion != Motion::fixed) moving.push_back(static_cast<int>(f));
  return moving;
}

std::vector<Parameter> parameters(const Model& model) {
  const Span span = moving_span(model);
  std::vector<Parameter> list;
  for (int f = 0; f < static_cast<int>(model.frames.size()); ++f) {
    const Frame& frame = model.frames[f];
    const Part part = f < span.first ? Part::base : f > span.last ? Part::tool : Part::link;
    for (int i = 0; i < kFields; ++i) {
      Parameter p;
      p.name = kNames[i] + std::to_string(f);
      p.frame = frame.name;
      p.field = kNames[i];
      p.quantity = is_angle(i) ? Quantity::angle : Quantity::length;
      p.part = part;
      p.value = frame.value[i];
      p.nominal = frame.nominal[i];
      p.tolerance = frame.tolerance[i] > 0 ? frame.tolerance[i]
                    : part == Part::link   ? kLinkTolerance
                                           : kPlacedTolerance;
      p.link_length = is_link_length(model, span, f, i);
      list.push_back(std::move(p));
    }
  }
  int joint = 0;
  for (const int f : moving_frames(model)) {
    const Frame& frame = model.frames[f];
    Parameter p{"K" + std::to_string(++joint), frame.name, "gear", Quantity::ratio, Part::gear};
    p.value = frame.gear;
    p.nominal = frame.gear_nominal;
    p.free = frame.gear_tolerance > 0;
    p.tolerance = p.free ? frame.gear_tolerance : kGearTolerance;
    list.push_back(std::move(p));
  }
  return list;
}

std::vector<int> preference(const Model& model) {
  const Span span = moving_span(model);
  const std::vector<int> moving = moving_frames(model);
  const int frames = static_cast<int>(model.frames.size());
  const int joints = static_cast<int>(moving.size());
  Order order(static_cast<size_t>(kFields * frames + joints));
  for (int j = 0; j < joints; ++j) order.add(kFields * frames + j);
  for (const int f : moving)
    order.add(index(f, model.frames[f].motion == Motion::revolute ? kTheta : kR));
  add_links(model, span, order);
  add_base(span, order);
  add_tool(span, frames, order);
  for (int f = 0; f < frames; ++f)
    for (const int field : {kAlpha, kD, kTheta, kR}) order.add(index(f, field));
  for (int f = 0; f < frames; ++f) order.add(index(f, kBeta));
  return order.columns_;
}

}  // namespace selfcal::serial
