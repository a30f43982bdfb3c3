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

constexpr double kGearTolerance = 1.0e-4;

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
  const Frame& frame = model.frames[f];
  if (is_angle(frame, field) || f <= span.first || f > span.last) return false;
  if (f == span.last && field == kR) return false;
  if (frame.motion == Motion::prismatic && field == kR) return false;
  return frame.nominal[field] != 0;
}

/// Appends columns, each only once.
class Order {
 public:
  explicit Order(const Model& model)
      : model_(model),
        first_(first_parameters(model)),
        taken_(static_cast<size_t>(first_.back()) + moving_frames(model).size(), false) {}

  /// K of a joint.
  void add_gear(int joint) { add(first_.back() + joint); }
  /// One of a frame's five; of a whole pose nothing.
  void add(int frame, Field field) {
    if (!model_.frames[frame].whole) add_any(frame, field);
  }
  /// Any parameter of a frame, five or six as they are.
  void add_any(int frame, int field) { add(first_[frame] + field); }
  /// All six of the whole poses among the frames [begin, end).
  void add_whole_poses(int begin, int end) {
    for (int f = begin; f < end; ++f)
      for (int field = 0; model_.frames[f].whole && field < kPoseFields; ++field) add_any(f, field);
  }
  std::vector<int> columns_;

 private:
  void add(int column) {
    if (taken_[column]) return;
    taken_[column] = true;
    columns_.push_back(column);
  }

  const Model& model_;
  std::vector<int> first_;
  std::vector<bool> taken_;
};

void add_links(const Model& model, Span span, Order& order) {
  struct Length {
    double length;
    int frame, field;
  };
  std::vector<Length> lengths;
  for (int f = span.first + 1; f <= span.last; ++f)
    for (int field = 0; field < model.frames[f].fields(); ++field)
      if (is_link_length(model, span, f, field))
        lengths.push_back({std::abs(model.frames[f].nominal[field]), f, field});
  std::ranges::stable_sort(lengths, {}, &Length::length);
  for (const Length& each : lengths) order.add_any(each.frame, each.field);
  for (int f = span.first + 1; f <= span.last; ++f)
    for (const Field field : {kAlpha, kTheta})
      if (!model.frames[f].whole && !is_quarter_turn(model.frames[f].nominal[field]))
        order.add(f, field);
}

void add_base(Span span, Order& order) {
  order.add_whole_poses(0, span.first);
  for (int f = span.first; f > 0; --f) order.add(f, kAlpha);
  for (int f = span.first - 1; f >= 0; --f) {
    order.add(f, kR);
    order.add(f, kTheta);
  }
  for (int f = span.first; f > 0; --f) order.add(f, kD);
  order.add(span.first, kTheta);
  order.add(span.first, kR);
}

void add_tool(Span span, int frames, Order& order) {
  order.add_whole_poses(span.last + 1, frames);
  for (int f = span.last + 1; f < frames; ++f) order.add(f, kD);
  order.add(span.last, kR);
  for (const Field field : {kAlpha, kTheta, kR})
    for (int f = span.last + 1; f < frames; ++f) order.add(f, field);
}

}  // namespace

std::vector<int> moving_frames(const Model& model) {
  std::vector<int> moving;
  for (size_t f = 0; f < model.frames.size(); ++f)
    if (model.frames[f].motion != Motion::fixed) moving.push_back(static_cast<int>(f));
  return moving;
}

std::vector<int> first_parameters(const Model& model) {
  std::vector<int> first{0};
  for (const Frame& frame : model.frames) first.push_back(first.back() + frame.fields());
  return first;
}

std::vector<Parameter> parameters(const Model& model) {
  const Span span = moving_span(model);
  std::vector<Parameter> list;
  for (int f = 0; f < static_cast<int>(model.frames.size()); ++f) {
    const Frame& frame = model.frames[f];
    const Part part = f < span.first ? Part::base : f > span.last ? Part::tool : Part::link;
    for (int i = 0; i < frame.fields(); ++i) {
      Parameter p;
      p.frame = frame.name;
      p.field = field_names(frame.whole)[i];
      p.name = frame.whole ? p.frame + "." + p.field : p.field + std::to_string(f);
      p.quantity = is_angle(frame, i) ? Quantity::angle : Quantity::length;
      p.part = part;
      p.value = frame.value[i];
      p.nominal = frame.nominal[i];
      p.tolerance = frame.tolerance[i] > 0 ? frame.tolerance[i]
                    : part == Part::link   ? kLinkTolerance
                                           : kPlacedTolerance;
      p.link_length = is_link_length(model, span, f, i);
      p.of_whole_pose = frame.whole;
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
    p.tolerance = frame.gear_tolerance >= 0 ? frame.gear_tolerance : kGearTolerance;
    list.push_back(std::move(p));
  }
  return list;
}

std::vector<int> preference(const Model& model) {
  const Span span = moving_span(model);
  const std::vector<int> moving = moving_frames(model);
  const int frames = static_cast<int>(model.frames.size());
  Order order(model);
  for (int j = 0; j < static_cast<int>(moving.size()); ++j) order.add_gear(j);
  for (const int f : moving) order.add(f, model.frames[f].motion == Motion::revolute ? kTheta : kR);
  add_links(model, span, order);
  add_base(span, order);
  add_tool(span, frames, order);
  order.add_whole_poses(0, frames);
  for (int f = 0; f < frames; ++f)
    for (const Field field : {kAlpha, kD, kTheta, kR}) order.add(f, field);
  for (int f = 0; f < frames; ++f) order.add(f, kBeta);
  return order.columns_;
}

}  // namespace selfcal::serial
